#pragma once

// A function on the sphere as a surface: as far from the center as its absolute value, red where positive,
// blue where negative.

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>
#include <vector>

namespace viewer {

struct ColoredMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec4> colors; ///< linear, lit from `towards_eye`
    std::vector<glm::uvec3> triangles;
};

/// `function` [order²]; its largest absolute value lies at distance `radius` from `center`.
ColoredMesh make_lobe(int order, std::span<const float> function, const glm::vec3& center, float radius,
                      const glm::vec3& towards_eye);

} // namespace viewer
