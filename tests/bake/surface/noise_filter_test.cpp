// Light at receivers without the noise of its rays.

#include "prt/bake/bake.h"
#include "prt/core/error_measures.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace prt {
namespace {

using test::SceneBuilder;

BakeOptions bounced(int rays, std::uint64_t seed, bool denoise) {
    BakeOptions options;
    options.order = 2;
    options.rays = rays;
    options.seed = seed;
    options.bounces = 1;
    options.repairs.denoise = denoise;
    options.tracer.backend = Backend::cpu;
    return options;
}

/// Bounced light of the one lamp.
Transfer indirect(const Scene& scene, BakeOptions options, bool* denoised = nullptr) {
    options.lamps.mode = LampMode::indirect;
    const BakeResult result = bake(scene, options);
    if (denoised)
        *denoised = result.noise.filtered;
    const Transfer& all = result.baked.transfer;
    Transfer light = zero_transfer(1, 1, all.receivers());
    for (std::size_t v = 0; v < all.receivers(); ++v)
        light.vector(v)[0] = all.vector(v).back();
    return light;
}

/// Returns a floor next to a wall that lights it, and a ball that shadows both.
Scene corner() {
    SceneBuilder wall;
    for (int i = -8; i < 8; ++i)
        for (int j = 0; j < 16; ++j) {
            const float x = 0.25f * static_cast<float>(i), y = 0.25f * static_cast<float>(j);
            wall.quad({x, y, -2}, {x + 0.25f, y, -2}, {x + 0.25f, y + 0.25f, -2}, {x, y + 0.25f, -2});
        }
    Scene scene = test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 16).build(), wall.build(),
                                            SceneBuilder().sphere({0, 0.6f, 0}, 0.5f, 16).build()}),
                                glm::vec3(0.8f));
    scene.lights = {test::lamp_at({1.2f, 1.5f, 1})};
    return scene;
}

TEST(NoiseFilter, RemovesMostNoise) {
    const Scene scene = corner();
    const std::vector<float> areas = receiver_areas(scene);
    const Transfer truth = indirect(scene, bounced(1 << 14, 9, false));
    for (const std::uint64_t seed : {1, 2}) {
        bool with = false, without = true;
        const Transfer filtered = indirect(scene, bounced(128, seed, true), &with),
                       noisy = indirect(scene, bounced(128, seed, false), &without);
        EXPECT_TRUE(with);
        EXPECT_FALSE(without);
        const double after = relative_l2(truth, filtered, areas), before = relative_l2(truth, noisy, areas);
        EXPECT_GT(before, 0.02);
        EXPECT_LT(after, 0.7 * before);
    }
}

TEST(NoiseFilter, ChangesLittleWithoutNoise) {
    const Scene scene = corner();
    const std::vector<float> areas = receiver_areas(scene);
    const Transfer truth = indirect(scene, bounced(1 << 14, 9, false));
    EXPECT_LT(relative_l2(truth, indirect(scene, bounced(1 << 12, 1, true)), areas),
              1.05 * relative_l2(truth, indirect(scene, bounced(1 << 12, 1, false)), areas));
}

/// Light of lamps without a bounce has no noise of hemisphere rays, and stays as it is, bit by bit.
TEST(NoiseFilter, KeepsDirectLightOfLamps) {
    const Scene scene = corner();
    BakeOptions with = bounced(64, 1, true), without = bounced(64, 1, false);
    with.bounces = without.bounces = 0;
    const Transfer filtered = bake(scene, with).baked.transfer, noisy = bake(scene, without).baked.transfer;
    ASSERT_EQ(filtered.layout.terms.back().kind, TermKind::lamp);
    for (std::size_t v = 0; v < filtered.receivers(); ++v)
        ASSERT_EQ(filtered.vector(v).back(), noisy.vector(v).back());
}

/// Tests the noise of a sky, whose direct light has an edge where the ball touches the floor.
TEST(NoiseFilter, RemovesMostNoiseOfASky) {
    const Scene scene = corner();
    const std::vector<float> areas = receiver_areas(scene);
    for (const int bounces : {0, 2}) {
        const auto sky = [&](int rays, std::uint64_t seed, bool denoise) {
            BakeOptions options = bounced(rays, seed, denoise);
            options.bounces = bounces;
            options.order = 4;
            options.lamps.mode = LampMode::none;
            return bake(scene, options);
        };
        const Transfer truth = sky(1 << 14, 9, false).baked.transfer;
        const BakeResult filtered = sky(128, 1, true);
        const double before = relative_l2(truth, sky(128, 1, false).baked.transfer, areas),
                     after = relative_l2(truth, filtered.baked.transfer, areas);
        EXPECT_GT(before, 0.01);
        EXPECT_LT(after, 0.75 * before) << bounces;
        EXPECT_NEAR(filtered.statistics.sampling_error, after, 0.35 * after) << bounces;
        EXPECT_LT(relative_l2(truth, sky(1 << 12, 1, true).baked.transfer, areas),
                  1.02 * relative_l2(truth, sky(1 << 12, 1, false).baked.transfer, areas));
    }
}

/// Rays that miss the sky and rays that hit a wall have common noise: filtered separately they would not add
/// up.
TEST(NoiseFilter, KeepsAllLightOfAWhiteFurnace) {
    Scene scene = corner();
    scene.lights.clear();
    scene = test::painted(std::move(scene), glm::vec3(1));
    BakeOptions options = bounced(64, 1, true);
    options.bounces = kEndlessBounces;
    const BakeResult result = bake(scene, options);
    EXPECT_TRUE(result.noise.filtered);
    const Transfer& transfer = result.baked.transfer;
    for (std::size_t v = 0; v < transfer.receivers(); ++v) {
        float all = 0;
        for (std::size_t first = 0; first < transfer.dimension(); first += 4) // direct, and the rest
            all += transfer.vector(v)[first];
        ASSERT_NEAR(all * std::sqrt(4 * std::numbers::pi_v<float>), 1, 1e-3f) << v;
    }
}

/// Transfer is that of a surface of albedo 1, so it has no step where two materials meet.
TEST(NoiseFilter, SeesNoBoundaryOfMaterials) {
    const Scene one = corner();
    Scene two = one;
    const auto dark = static_cast<std::uint32_t>(two.materials.size());
    two.materials.push_back(two.materials.front());
    two.materials.back().base_color = glm::vec4(0.1f, 0.1f, 0.1f, 1);
    two.primitives.front().material = dark;
    BakeOptions options = bounced(128, 1, true);
    options.bounces = 0;
    EXPECT_EQ(bake(one, options).baked.transfer.vectors, bake(two, options).baked.transfer.vectors);
}

/// Two rooms on one floor, one of them with a lamp. The wall between them is on vertices of the floor.
TEST(NoiseFilter, LightsNoDarkRoom) {
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
    scene.lights = {test::lamp_at({-0.5f, 1, 0.2f})};
    BakeOptions options = bounced(64, 1, true);
    options.bounces = 3;
    const BakeResult result = bake(scene, options);
    EXPECT_TRUE(result.noise.filtered);
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
