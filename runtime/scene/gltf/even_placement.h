#pragma once

#include "prt/instances_gltf.h"

#include <glm/mat4x4.hpp>

#include <optional>

namespace prt {

/// What `world` does, where that is a rotation, an even scale and a move; nothing where it mirrors, shears,
/// is singular or scales unevenly.
std::optional<MeshPlacement> even_placement(int node, const glm::dmat4& world);

} // namespace prt
