// A trunk with leaves spread over a crown, randomly bent and rotated.

#include "example_scenes.h"
#include "leaf.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <random>

namespace examples {
namespace {

Mesh trunk() {
    return parametric_surface(16, 24, [](float u, float v) {
        const float radius = 0.16f - 0.1f * v;
        return glm::vec3(radius * std::sin(kTurn * u) + 0.1f * v * v, 2.2f * v, radius * std::cos(kTurn * u));
    });
}

} // namespace

ExampleScene tree() {
    std::mt19937 random(41);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit(0, 1);
    const auto direction = [&] {
        return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    };
    Mesh leaves;
    for (int i = 0; i < 700; ++i) {
        const glm::vec3 out = direction();
        const float radius = 0.95f * std::cbrt(0.25f + 0.75f * unit(random));
        const glm::vec3 base = glm::vec3(0.1f, 2.5f, 0) + radius * out * glm::vec3(1.1f, 0.85f, 1.1f);
        const glm::vec3 along = glm::normalize(out + 0.7f * direction() + glm::vec3(0, -0.3f, 0));
        const glm::vec3 side = glm::normalize(glm::cross(along, direction()));
        append(leaves, leaf(base, along, side, 0.28f + 0.14f * unit(random), 4, 6));
    }
    Part crown{"leaves", {0.10f, 0.26f, 0.05f}, leaves, 0.45f, {0.32f, 0.55f, 0.06f}};
    return {.parts = {{"ground", {0.45f, 0.42f, 0.36f}, rectangle({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, 0.08f)},
                      {"trunk", {0.23f, 0.15f, 0.10f}, trunk()},
                      crown}};
}

} // namespace examples
