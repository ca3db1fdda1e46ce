#pragma once

// Decomposition of node matrices.

#include "prt/gltf/transfer_gltf.h"

#include <glm/mat4x4.hpp>

#include <optional>

namespace prt {

/// Decomposes `world` into rotation, uniform scale and translation; empty if it mirrors, shears, is singular
/// or scales non-uniformly.
std::optional<MeshPlacement> even_placement(int node, const glm::dmat4& world);

} // namespace prt
