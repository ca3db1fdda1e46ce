// A (2, 3) torus knot over a plane: soft contact shadows, and a surface that shadows itself.

#include "example_scenes.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace examples {
namespace {

glm::vec3 knot_curve(float t) {
    const float radius = 1.0f + 0.4f * std::cos(3 * t);
    return {radius * std::cos(2 * t), 0.5f * std::sin(3 * t), radius * std::sin(2 * t)};
}

glm::vec3 knot_surface(float u, float v) {
    constexpr float kTube = 0.24f, kStep = 1e-3f;
    const float t = kTurn * u;
    const glm::vec3 center = knot_curve(t),
                    tangent = glm::normalize(knot_curve(t + kStep) - knot_curve(t - kStep));
    const glm::vec3 side = glm::normalize(glm::cross(glm::vec3(0, 1, 0), tangent)),
                    up = glm::cross(tangent, side);
    return center + kTube * (std::cos(kTurn * v) * side - std::sin(kTurn * v) * up);
}

} // namespace

ExampleScene torus_knot_over_plane() {
    return {.parts = {{"knot", {0.85f, 0.55f, 0.25f}, parametric_surface(240, 28, knot_surface)},
                      {"plane",
                       {0.6f, 0.6f, 0.6f},
                       rectangle({-2.6f, -0.85f, 2.6f}, {5.2f, 0, 0}, {0, 0, -5.2f}, 0.08f)}}};
}

} // namespace examples
