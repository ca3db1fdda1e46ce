// Tests bakes that choose the number of rays for a target error.

#include "prt/bake/bake.h"
#include "prt/core/error_measures.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

Scene balls_over_floor() {
    return test::SceneBuilder()
        .floor({0, 0, 0}, 2, 16)
        .sphere({0, 0.8f, 0}, 0.5f, 20)
        .sphere({0.9f, 0.4f, 0.2f}, 0.3f, 16)
        .build();
}

BakeOptions cpu_options() {
    BakeOptions options;
    options.tracer.backend = Backend::cpu;
    return options;
}

double error_against_reference(const Scene& scene, const Transfer& transfer) {
    BakeOptions options = cpu_options();
    options.rays = 1 << 15;
    options.seed = 1234567;
    return relative_l2(bake(scene, options).baked.transfer, transfer, receiver_areas(scene));
}

TEST(TargetError, IsReachedAndSoIsTheEstimate) {
    const Scene scene = balls_over_floor();
    for (const double target : {0.03, 0.01}) {
        BakeOptions options = cpu_options();
        options.target_error = target;
        const BakeResult result = bake(scene, options);
        EXPECT_LE(result.statistics.sampling_error, target);
        const double error = error_against_reference(scene, result.baked.transfer);
        // Reference and estimate have some error themselves.
        EXPECT_LT(error, 1.25 * target);
        EXPECT_GT(error, 0.4 * target); // no rays thrown away
        EXPECT_NEAR(result.statistics.sampling_error, error, 0.35 * error);
    }
}

TEST(TargetError, NeedsFewerRaysThanUniformSampling) {
    const Scene scene = balls_over_floor();
    BakeOptions options = cpu_options();
    options.repairs.denoise = false;
    options.target_error = 0.01;
    const BakeResult adaptive = bake(scene, options);
    options.target_error.reset();
    options.rays = static_cast<int>(adaptive.statistics.rays / adaptive.statistics.receivers.traced);
    const BakeResult uniform = bake(scene, options);
    EXPECT_LT(error_against_reference(scene, adaptive.baked.transfer),
              error_against_reference(scene, uniform.baked.transfer));
}

TEST(TargetError, OpenReceiversNeedOnlyTheFirstRays) {
    BakeOptions options = cpu_options();
    options.target_error = 1e-6;
    const BakeResult result = bake(test::SceneBuilder().floor({0, 0, 0}, 1, 4).build(), options);
    EXPECT_EQ(result.statistics.sampling_error, 0);
    EXPECT_EQ(result.statistics.rays, 64 * result.statistics.receivers.traced);
}

TEST(TargetError, LooseTargetsNeedOnlyTheFirstRays) {
    BakeOptions options = cpu_options();
    options.order = 2;
    options.target_error = 10;
    const BakeStatistics statistics =
        bake(test::SceneBuilder().bowl({0, 0, 0}, 1, 12, 4).build(), options).statistics;
    // Two scrambles of 32 rays, and a third one for 128 receivers. No receiver is dark, so the check for
    // sealed receivers traces no rays.
    EXPECT_LE(statistics.rays, 64 * statistics.receivers.traced + 128 * 32);
}

TEST(TargetError, ExactlyReachedTargetsNeedNoMoreRays) {
    // For about every other seed a sample has a larger error than predicted: the prediction then requires no
    // more rays.
    BakeOptions options = cpu_options();
    options.order = 2;
    options.repairs.denoise = false;
    const Scene scene = balls_over_floor();
    bool same = false;
    for (; !same && options.seed < 12; ++options.seed) {
        options.target_error = 10;
        const BakeStatistics first = bake(scene, options).statistics;
        options.target_error = first.sampling_error;
        const BakeStatistics again = bake(scene, options).statistics;
        EXPECT_LE(again.sampling_error, first.sampling_error);
        same = again.rays == first.rays;
    }
    EXPECT_TRUE(same);
}

TEST(TargetError, FindsTheWindowOfADarkRoom) {
    // A bowl that is closed except for its first ring: one ray in a hundred reaches the sky, and for most
    // receivers none of the first 64.
    constexpr int kRows = 16;
    const Scene scene = test::SceneBuilder().bowl({0, 0, 0}, 1, kRows, 1).build();
    const double open = (1 - std::cos(std::numbers::pi / kRows)) / 2;
    BakeOptions options = cpu_options();
    options.order = 3;
    options.target_error = 0.1;
    const BakeResult result = bake(scene, options);
    EXPECT_NEAR(result.statistics.mean_visibility, open, 0.05 * open);
    options.target_error.reset();
    options.rays = 1 << 16;
    options.seed = 99;
    const double error =
        relative_l2(bake(scene, options).baked.transfer, result.baked.transfer, receiver_areas(scene));
    EXPECT_LT(error, 0.12); // the reference has some error, too
    EXPECT_NEAR(result.statistics.sampling_error, error, 0.35 * error);
}

TEST(TargetError, WorksWithBounces) {
    BakeOptions options = cpu_options();
    options.target_error = 0.03;
    options.bounces = 2;
    const BakeResult result = bake(balls_over_floor(), options);
    EXPECT_EQ(result.baked.record.bounces, 2);
    EXPECT_GT(result.baked.record.rays, 64);
}

TEST(TargetError, IsReachedByFitsToTheSurface) {
    const Scene scene = balls_over_floor();
    BakeOptions options = cpu_options();
    options.order = 3;
    options.fit = FitMode::surface;
    options.rays = 1 << 14;
    const Transfer reference = bake(scene, options).baked.transfer;
    for (const double target : {0.03, 0.01}) {
        options.target_error = target;
        const BakeResult result = bake(scene, options);
        EXPECT_TRUE(result.baked.record.fitted);
        EXPECT_LE(result.statistics.sampling_error, target);
        // The estimate of a fit is correct within a factor of two (FittedBake.EstimatesItsNoise).
        const double error = relative_l2(reference, result.baked.transfer, receiver_areas(scene));
        EXPECT_LT(error, 2 * target);
        EXPECT_GT(error, 0.2 * target); // no rays thrown away
    }
}

TEST(SamplingError, IsEstimatedForEveryBake) {
    const Scene scene = balls_over_floor();
    for (const int rays : {100, 1024}) {
        BakeOptions options = cpu_options();
        options.rays = rays;
        const BakeResult result = bake(scene, options);
        const double error = error_against_reference(scene, result.baked.transfer);
        EXPECT_NEAR(result.statistics.sampling_error, error, 0.35 * error) << rays;
    }
}

TEST(Storage, IsFloat16ForTenTimesLargerSamplingError) {
    const Scene scene = balls_over_floor();
    BakeOptions options = cpu_options();
    options.rays = 256;
    EXPECT_EQ(bake(scene, options).baked.storage, TransferStorage::float16);
    options.target_error = 5e-4;
    EXPECT_EQ(bake(scene, options).baked.storage, TransferStorage::float32);
    options.target_error.reset();
    options.memory.storage = TransferStorage::float32;
    EXPECT_EQ(bake(scene, options).baked.storage, TransferStorage::float32);
    options.memory.storage = TransferStorage::float16;
    const BakeResult result = bake(scene, options);
    EXPECT_EQ(result.baked.storage, TransferStorage::float16);
    Transfer rounded = result.baked.transfer;
    for (float& value : rounded.vectors)
        value = glm::unpackHalf1x16(glm::packHalf1x16(value));
    EXPECT_NEAR(result.statistics.rounding_error,
                relative_l2(result.baked.transfer, rounded, receiver_areas(scene)), 1e-9);
}

TEST(SamplingError, IsUnbiasedForFixedRays) {
    const Scene scene = balls_over_floor();
    const std::vector<float> areas = receiver_areas(scene);
    const auto baked = [&](int rays, std::uint64_t seed) {
        BakeOptions options;
        options.order = 3;
        options.rays = rays;
        options.seed = seed;
        options.tracer.backend = Backend::cpu;
        options.memory.storage = TransferStorage::float32;
        options.repairs.denoise = false;
        return bake(scene, options);
    };
    const Transfer reference = baked(1 << 14, 77).baked.transfer;
    double estimated = 0, real = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const BakeResult result = baked(64, seed);
        const double error = relative_l2(reference, result.baked.transfer, areas);
        EXPECT_NEAR(result.statistics.sampling_error, error, 0.15 * error) << seed;
        estimated += result.statistics.sampling_error;
        real += error;
    }
    EXPECT_NEAR(estimated, real, 0.03 * real);
}

} // namespace
} // namespace prt
