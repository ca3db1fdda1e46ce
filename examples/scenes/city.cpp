// Blocks of buildings with streets between them, of random height.

#include "example_scenes.h"

#include <glm/geometric.hpp>

#include <random>

namespace examples {
namespace {

/// A grid of 3 x 4 cells: 20 vertices, 24 triangles.
Mesh wall(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v) {
    return parametric_surface(3, 4, [&](float u, float v) { return corner + u * edge_u + v * edge_v; });
}

void add_building(Mesh& mesh, const glm::vec3& corner, float width, float depth, float height) {
    const glm::vec3 x(width, 0, 0), y(0, height, 0), z(0, 0, depth);
    append(mesh, wall(corner + z, x, y));
    append(mesh, wall(corner + x + z, -z, y));
    append(mesh, wall(corner + x, -x, y));
    append(mesh, wall(corner, z, y));
    append(mesh, wall(corner + y + z, x, -z));
}

} // namespace

ExampleScene city() {
    constexpr int kBlocks = 50, kAcross = 3, kDeep = 2; // 50 x 50 blocks of 6 buildings, five walls each
    constexpr float kPitch = 60, kWidth = 14, kDepth = 20, kGap = 2;
    std::mt19937 random(2004);
    std::exponential_distribution<float> taller(1.0f / 14);
    std::uniform_real_distribution<float> unit(0, 1);
    Mesh buildings;
    for (int i = 0; i < kBlocks; ++i)
        for (int j = 0; j < kBlocks; ++j)
            for (int a = 0; a < kAcross; ++a)
                for (int b = 0; b < kDeep; ++b) {
                    const glm::vec3 corner((static_cast<float>(i) - 0.5f * kBlocks) * kPitch +
                                               static_cast<float>(a) * (kWidth + kGap),
                                           0,
                                           (static_cast<float>(j) - 0.5f * kBlocks) * kPitch +
                                               static_cast<float>(b) * (kDepth + kGap));
                    add_building(buildings, corner, kWidth, kDepth * (0.7f + 0.3f * unit(random)),
                                 6 + taller(random));
                }
    const float half = 0.5f * kBlocks * kPitch;
    return {.parts = {{"ground",
                       {0.35f, 0.35f, 0.36f},
                       rectangle({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, 15)},
                      {"buildings", {0.6f, 0.58f, 0.55f}, buildings}}};
}

} // namespace examples
