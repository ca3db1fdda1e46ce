// Tests that no sky light enters closed rooms, for all walls, spacings and positions of the grid.

#include "bake/products/volumes/visibility.h"
#include "prt/bake/volume_bake.h"
#include "prt/core/sh.h"
#include "prt/core/transfer.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using test::SceneBuilder;

/// The sides of a box, as large as their quads; fronts outside, or inside.
Scene box(const glm::vec3& low, const glm::vec3& high, bool inwards) {
    SceneBuilder builder;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        glm::vec3 a = low, du(0), dv(0);
        a[axis] = side % 2 == 0 ? low[axis] : high[axis];
        du[u] = high[u] - low[u];
        dv[v] = high[v] - low[v];
        if ((side % 2 == 0) == inwards)
            builder.quad(a, a + du, a + du + dv, a + dv);
        else
            builder.quad(a, a + dv, a + du + dv, a + du);
    }
    return builder.build();
}

struct Leak {
    double mean = 0, largest = 0;
};

/// Returns the light in a closed room of 3 x 2.4 x 3.4 m relative to that of the sky; no sky light enters it.
Leak leak_into_room(float wall, float spacing, bool double_sided, const glm::vec3& shift) {
    const glm::vec3 low(-1.5f, -1.2f, -1.7f), high = -low;
    Scene scene = box(low, high, true);
    if (wall > 0)
        scene = test::join({scene, box(low - wall, high + wall, false)});
    scene = test::painted(scene, glm::vec3(0), double_sided);
    BakeOptions options;
    options.order = 2;
    options.rays = 512;
    options.tracer.backend = Backend::cpu;
    const glm::vec3 margin = glm::vec3(wall) + shift * spacing;
    const VolumeBake bake = bake_volume(scene,
                                        {.spacing = static_cast<double>(spacing),
                                         .bounds = Bounds{low - margin, high + wall},
                                         .fit_points = 0},
                                        options);
    const std::vector<glm::vec3> at_probes =
        exit_radiance(bake.volume.baked.transfer, constant_light(2, glm::vec3(1)));
    const VolumeLookup lookup(bake.volume.grid, bake.volume.visibility);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.005f, 0.995f);
    Leak leak;
    std::array<glm::vec3, 9> light;
    constexpr int kPositions = 1000;
    for (int i = 0; i < kPositions; ++i) {
        const float x = unit(random), y = unit(random), z = unit(random);
        mix_incident(lookup.find(low + (high - low) * glm::vec3(x, y, z)), at_probes, light);
        const double share = static_cast<double>(light[0].x) / std::sqrt(4 * std::numbers::pi);
        leak.mean += std::abs(share) / kPositions;
        leak.largest = std::max(leak.largest, std::abs(share));
    }
    return leak;
}

/// Returns the visibility distances of a probe with evenly distributed rays in front of the plane normal·x =
/// offset. `limit` is the extent of the plane from its middle.
std::array<float, 6> distances_before(const glm::vec3& normal, float offset, float limit) {
    constexpr int kRays = 20000;
    VisibilityVotes votes;
    votes.begin(glm::vec3(0), 1);
    for (int i = 0; i < kRays; ++i) {
        const double y = 1 - (2 * i + 1.0) / kRays, rotation = 2 * std::numbers::pi * i / std::numbers::phi,
                     radius = std::sqrt(1 - y * y);
        const glm::vec3 d(radius * std::cos(rotation), y, radius * std::sin(rotation));
        const float along = offset / glm::dot(normal, d);
        if (along > 0 && glm::length(d * along - normal * offset) < limit)
            votes.add_hit(d * along, normal, 1);
    }
    return votes.distances(kRays, 4);
}

TEST(VisibilityVotes, StopAtWallsAlongTheAxes) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float offset : {0.1f, 0.6f, 0.95f}) {
                glm::vec3 normal(0);
                normal[axis] = sign;
                const auto distances = distances_before(normal, offset, 2);
                for (int a = 0; a < 6; ++a) {
                    const bool wall = a == 2 * axis + (sign > 0 ? 1 : 0);
                    EXPECT_NEAR(distances[static_cast<std::size_t>(a)], wall ? offset : 4, 1e-5f);
                }
            }
}

TEST(VisibilityVotes, EndBeforeSlantedWalls) {
    // The corner of the box lies before the wall, or a little behind.
    for (const glm::vec3& towards : {glm::vec3(1, 1, 0), glm::vec3(-2, 1, 0), glm::vec3(1, 1, 1)}) {
        const glm::vec3 normal = glm::normalize(towards);
        const auto distances = distances_before(normal, 0.4f, 4);
        glm::vec3 corner;
        for (int a = 0; a < 3; ++a)
            corner[a] =
                towards[a] == 0
                    ? 0.0f
                    : std::copysign(distances[static_cast<std::size_t>(2 * a + (towards[a] > 0 ? 1 : 0))],
                                    towards[a]);
        EXPECT_LT(glm::dot(corner, normal), 0.8f) << towards.x;
        EXPECT_GT(glm::dot(corner, normal), 0.4f) << towards.x;
    }
}

TEST(VisibilityVotes, PassPoles) {
    EXPECT_EQ(distances_before({1, 0, 0}, 0.5f, 0.1f)[1], 4); // 5 % of the axis
    EXPECT_NEAR(distances_before({1, 0, 0}, 0.5f, 0.4f)[1], 0.5f, 1e-5f);
}

/// Returns the worst leak over some positions of the grid.
Leak worst_leak(float wall, float spacing, bool double_sided) {
    Leak worst;
    for (const glm::vec3& shift :
         {glm::vec3(0), glm::vec3(0.31f, 0.77f, 0.12f), glm::vec3(0.93f, 0.41f, 0.58f)}) {
        const Leak leak = leak_into_room(wall, spacing, double_sided, shift);
        worst.mean = std::max(worst.mean, leak.mean);
        worst.largest = std::max(worst.largest, leak.largest);
    }
    return worst;
}

TEST(VolumeLeaks, LittleLightPassesWalls) {
    for (const bool double_sided : {false, true})
        for (const float wall : {0.05f, 0.1f, 0.3f})
            for (const float spacing : {0.5f, 1.0f}) {
                const Leak leak = worst_leak(wall, spacing, double_sided);
                EXPECT_LT(leak.mean, 5e-3) << wall << " " << spacing << " " << double_sided;
                EXPECT_LT(leak.largest, 0.05) << wall << " " << spacing << " " << double_sided;
            }
}

// Weights go from one side to the other within 3 % of a probe's distance from a wall.
TEST(VolumeLeaks, LittleLightPassesSheets) {
    for (const bool double_sided : {false, true}) {
        const Leak leak = worst_leak(0, 0.5f, double_sided);
        EXPECT_LT(leak.mean, 1e-3) << double_sided;
        EXPECT_LT(leak.largest, 0.05) << double_sided;
    }
}

} // namespace
} // namespace prt
