#pragma once

// Draws a function on the sphere as a surface. The distance from the center is the absolute value; positive
// values are red, negative ones blue.

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>
#include <vector>

namespace viewer {

struct ColoredMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec4> colors; ///< linear, shaded for light from `towards_eye`
    std::vector<glm::uvec3> triangles;
};

/// Returns the surface of `function` [order²]; its maximum absolute value is at distance `radius` from
/// `center`.
ColoredMesh make_lobe(int order, std::span<const float> function, const glm::vec3& center, float radius,
                      const glm::vec3& towards_eye);

} // namespace viewer
