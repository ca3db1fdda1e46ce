#pragma once

// Decomposition of node matrices.

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <optional>

namespace prt {

/// Rotation and uniform scale of a transform to the world.
struct EvenPlacement {
    glm::dmat3 rotation{1};
    double scale = 1;
};

/// Decomposes `world` into rotation, uniform scale and translation; empty if it mirrors, shears, is singular
/// or scales non-uniformly.
std::optional<EvenPlacement> even_placement(const glm::dmat4& world);

} // namespace prt
