// Bounced light without the noise of its rays.

#include "prt/bake.h"
#include "prt/error_measures.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

BakeOptions bounced(int rays, std::uint64_t seed, bool denoise) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.seed = seed;
    options.bounces = 1;
    options.denoise = denoise;
    options.tracer.backend = Backend::cpu;
    return options;
}

/// The part of bounced light.
Transfer indirect(const Transfer& all) {
    for (std::size_t p = 0, first = 0; p < all.layout.parts.size(); ++p) {
        const std::size_t numbers = all.layout.numbers_of(all.layout.parts[p]);
        if (all.layout.parts[p].kind == PartKind::indirect) {
            Transfer part = zero_transfer(all.layout.order, all.layout.parts[p].channels, all.receivers());
            for (std::size_t v = 0; v < all.receivers(); ++v)
                std::ranges::copy(all.vector(v).subspan(first, numbers), part.vector(v).begin());
            return part;
        }
        first += numbers;
    }
    return {};
}

/// A floor beside a wall that lights it, and a ball that shades both.
Scene corner() {
    SceneBuilder wall;
    for (int i = -8; i < 8; ++i)
        for (int j = 0; j < 16; ++j) {
            const float x = 0.25f * static_cast<float>(i), y = 0.25f * static_cast<float>(j);
            wall.quad({x, y, -2}, {x + 0.25f, y, -2}, {x + 0.25f, y + 0.25f, -2}, {x, y + 0.25f, -2});
        }
    return test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 16).build(), wall.build(),
                                     SceneBuilder().sphere({0, 0.6f, 0}, 0.5f, 16).build()}),
                         glm::vec3(0.8f));
}

TEST(BounceFilter, TakesMostOfTheNoise) {
    const Scene scene = corner();
    const std::vector<float> areas = receiver_areas(scene);
    const Transfer truth = indirect(bake(scene, bounced(1 << 14, 9, false)).baked.transfer);
    for (const std::uint64_t seed : {1, 2}) {
        const BakeResult filtered = bake(scene, bounced(128, seed, true)),
                         noisy = bake(scene, bounced(128, seed, false));
        EXPECT_TRUE(filtered.statistics.denoised);
        EXPECT_FALSE(noisy.statistics.denoised);
        const double after = relative_l2(truth, indirect(filtered.baked.transfer), areas),
                     before = relative_l2(truth, indirect(noisy.baked.transfer), areas);
        EXPECT_GT(before, 0.02);
        EXPECT_LT(after, 0.75 * before);
    }
}

TEST(BounceFilter, ChangesLittleWhereThereIsLittleNoise) {
    const Scene scene = corner();
    const std::vector<float> areas = receiver_areas(scene);
    const Transfer truth = indirect(bake(scene, bounced(1 << 14, 9, false)).baked.transfer),
                   filtered = indirect(bake(scene, bounced(1 << 12, 1, true)).baked.transfer),
                   noisy = indirect(bake(scene, bounced(1 << 12, 1, false)).baked.transfer);
    EXPECT_LT(relative_l2(truth, filtered, areas), 1.05 * relative_l2(truth, noisy, areas));
}

/// Direct light stays as it is, bit by bit.
TEST(BounceFilter, LeavesDirectLight) {
    const Scene scene = corner();
    const Transfer filtered = bake(scene, bounced(64, 1, true)).baked.transfer,
                   noisy = bake(scene, bounced(64, 1, false)).baked.transfer;
    ASSERT_EQ(filtered.layout.parts.front().kind, PartKind::direct);
    for (std::size_t v = 0; v < filtered.receivers(); ++v)
        for (std::size_t i = 0; i < 9; ++i)
            ASSERT_EQ(filtered.vector(v)[i], noisy.vector(v)[i]);
}

/// Two rooms on one floor, a lamp in one of them. The wall between them stands on vertices of the floor.
TEST(BounceFilter, LightsNoDarkRoom) {
    const auto room = [](float low, float high) {
        SceneBuilder walls;
        walls.quad({low, 0, -1}, {high, 0, -1}, {high, 2, -1}, {low, 2, -1});
        walls.quad({high, 0, 1}, {low, 0, 1}, {low, 2, 1}, {high, 2, 1});
        walls.quad({low, 2, -1}, {high, 2, -1}, {high, 2, 1}, {low, 2, 1});
        walls.quad({low, 0, 1}, {low, 0, -1}, {low, 2, -1}, {low, 2, 1});
        walls.quad({high, 0, -1}, {high, 0, 1}, {high, 2, 1}, {high, 2, -1});
        return walls.build();
    };
    SceneBuilder floor;
    for (int i = -8; i < 8; ++i)
        for (int j = -4; j < 4; ++j) {
            const float x = 0.25f * static_cast<float>(i), z = 0.25f * static_cast<float>(j);
            floor.quad({x, 0, z + 0.25f}, {x + 0.25f, 0, z + 0.25f}, {x + 0.25f, 0, z}, {x, 0, z});
        }
    Scene scene = test::painted(test::join({floor.build(), room(-2, 0), room(0, 2)}), glm::vec3(0.7f));
    PunctualLight light;
    light.name = "lamp";
    light.position = {-0.5f, 1, 0.2f};
    scene.lights = {light};
    BakeOptions options = bounced(64, 1, true);
    options.bounces = 3;
    const BakeResult result = bake(scene, options);
    EXPECT_TRUE(result.statistics.denoised);
    double lit = 0;
    for (const glm::uvec3& t : scene.primitives[0].triangles)
        for (int i = 0; i < 3; ++i) {
            const std::vector<glm::vec3>& at = scene.vertex_arrays[0].positions;
            const bool dark = at[t.x].x + at[t.y].x + at[t.z].x > 0;
            for (const float value : result.baked.transfer.vector(t[i]))
                if (dark)
                    ASSERT_EQ(value, 0) << at[t[i]].x << " " << at[t[i]].z;
                else
                    lit += static_cast<double>(value);
        }
    EXPECT_GT(lit, 1);
}

} // namespace
} // namespace prt
