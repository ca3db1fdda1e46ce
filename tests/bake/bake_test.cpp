// Tests the options of bakes, their errors and their statistics.

#include "prt/bake/bake.h"

#include "prt/core/error.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>

namespace prt {
namespace {

Scene sphere_over_floor() {
    return test::SceneBuilder().floor({0, 0, 0}, 2, 10).sphere({0, 0.8f, 0}, 0.5f, 16).build();
}

double distance(const Transfer& a, const Transfer& b) {
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < a.vectors.size(); ++i) {
        error += std::pow(static_cast<double>(a.vectors[i] - b.vectors[i]), 2);
        norm += std::pow(static_cast<double>(a.vectors[i]), 2);
    }
    return std::sqrt(error / norm);
}

Transfer bake_with(int rays, std::uint64_t seed, int threads = 0, bool denoise = true) {
    BakeOptions options;
    options.rays = rays;
    options.seed = seed;
    options.threads = threads;
    options.repairs.denoise = denoise;
    return bake(sphere_over_floor(), options).baked.transfer;
}

TEST(Bake, IsByteIdenticalForAllThreadCounts) {
    const Transfer one = bake_with(1500, 3, 1);
    EXPECT_EQ(one.vectors, bake_with(1500, 3, 2).vectors);
    EXPECT_EQ(one.vectors, bake_with(1500, 3, 5).vectors);
}

TEST(Bake, SeedsChangeOnlyTheNoise) {
    const Transfer a = bake_with(1024, 1), b = bake_with(1024, 1ull << 40);
    EXPECT_GT(distance(a, b), 1e-5);
    EXPECT_LT(distance(a, b), 0.03);
}

TEST(Bake, ErrorFallsFasterThanRandomSampling) {
    const auto noisy = [](int rays, std::uint64_t seed) { return bake_with(rays, seed, 0, false); };
    const Transfer reference = noisy(1 << 15, 99);
    const double few = distance(reference, noisy(256, 1)), many = distance(reference, noisy(4096, 2));
    // 16 times the rays: random sampling would gain 4.
    EXPECT_GT(few / many, 6) << few << " " << many;
    EXPECT_LT(many, 0.01);
}

TEST(Bake, HasNoBiasForRayCountsOtherThanPowersOfTwo) {
    const Transfer reference = bake_with(1 << 15, 99);
    for (const int rays : {1, 3, 17, 100, 1000, 1025, 3000})
        EXPECT_LT(distance(reference, bake_with(rays, 4)), 1.2 / std::sqrt(rays)) << rays;
}

TEST(Bake, ReportsStatistics) {
    BakeOptions options;
    options.rays = 64;
    const Scene scene = sphere_over_floor();
    const BakeResult result = bake(scene, options);
    EXPECT_EQ(result.statistics.receivers.all, scene.receivers());
    EXPECT_GT(result.statistics.rays_per_second(), 0);
    EXPECT_GT(result.statistics.mean_visibility, 0.5);
    EXPECT_LT(result.statistics.mean_visibility, 1);
    EXPECT_EQ(result.baked.record.receivers, receivers_id(scene));
}

TEST(Bake, RejectsUnsupportedOptions) {
    BakeOptions options;
    const Scene scene = sphere_over_floor();
    for (const int order : {0, 11, -1}) {
        options.order = order;
        EXPECT_THROW(bake(scene, options), Error);
    }
    options.order = 3;
    for (const int rays : {0, -5, 1 << 30}) {
        options.rays = rays;
        EXPECT_THROW(bake(scene, options), Error);
    }
    options.rays = 16;
    for (const int bounces : {-2, kMaxBounces + 1, 2147483647}) { // the last would take years
        options.bounces = bounces;
        EXPECT_THROW(bake(scene, options), Error);
    }
    options.bounces = 0;
    for (const double number : {0.0, std::nan(""), HUGE_VAL}) {
        BakeOptions bad = options;
        bad.target_error = number;
        EXPECT_THROW(bake(scene, bad), Error);
        bad = options;
        bad.subsurface.metres_per_unit = number;
        EXPECT_THROW(bake(scene, bad), Error);
    }
}

TEST(Bake, ReportsLimitsOfDepthMaps) {
    // Options are checked first, so this also holds on machines without a GPU.
    BakeOptions raster;
    raster.tracer.method = BakeMethod::raster;
    const auto expect_refusal = [](const BakeOptions& options, const char* reason) {
        try {
            bake(sphere_over_floor(), options);
            ADD_FAILURE() << "not refused: " << reason;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    };
    BakeOptions options = raster;
    options.tracer.backend = Backend::cpu;
    expect_refusal(options, "needs a GPU");
    options = raster;
    for (const int resolution : {15, 16385}) {
        options.tracer.raster_resolution = resolution;
        expect_refusal(options, "16..16384");
    }
}

TEST(Bake, StopsWhenAsked) {
    std::stop_source stop;
    BakeOptions options;
    options.rays = 1 << 20;
    std::atomic<int> calls = 0;
    const Progress progress{[&](double) {
                                if (++calls == 2)
                                    stop.request_stop();
                            },
                            stop.get_token()};
    EXPECT_THROW(bake(sphere_over_floor(), options, progress), Cancelled);
}

TEST(Bake, ReportsProgressFromZeroToOne) {
    double last = -1;
    BakeOptions options;
    options.rays = 4096;
    bake(sphere_over_floor(), options,
         {[&](double fraction) {
              EXPECT_GE(fraction, last);
              last = fraction;
          },
          {}});
    EXPECT_EQ(last, 1);
}

} // namespace
} // namespace prt
