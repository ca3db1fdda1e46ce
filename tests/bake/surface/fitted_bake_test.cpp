// Tests bakes whose vertices are fitted to the surface, against closed forms and denser bakes.

#include "bake/surface_fit/surface_samples.h"

#include "bake/trace/trace_receivers.h"
#include "bake/tracers/make_tracer.h"
#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"
#include "uneven_floor.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;
using test::uneven_floor;

BakeOptions fitted_options(int rays = 256) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.fit = FitMode::surface;
    return options;
}

TEST(FittedBake, IsTheCosineLobeWithoutShadows) {
    const Scene scene = uneven_floor(6);
    const BakeResult result = bake(scene, fitted_options());
    EXPECT_TRUE(result.baked.record.fitted);
    std::array<double, 9> lobe{};
    clamped_cosine_lobe(3, {0, 1, 0}, lobe);
    for (std::size_t p = 0; p < result.baked.transfer.receivers(); ++p)
        for (std::size_t i = 0; i < lobe.size(); ++i)
            EXPECT_NEAR(static_cast<double>(result.baked.transfer.vector(p)[i]), lobe[i], 1e-5);
    EXPECT_LT(result.statistics.sampling_error, 1e-6);
}

/// Returns a floor of large cells with a wall on it, off their edges.
Scene floor_with_wall() {
    return test::join(
        {SceneBuilder().floor({0, 0, 0}, 1, 8).build(),
         test::painted(SceneBuilder().quad({-1, 0, 0.1f}, {1, 0, 0.1f}, {1, 1, 0.1f}, {-1, 1, 0.1f}).build(),
                       glm::vec3(0.5f), true)});
}

/// Near the wall it covers half of the hemisphere; far from it, almost nothing.
TEST(FittedBake, HasLessErrorBetweenVerticesThanAVertexBake) {
    const Scene scene = floor_with_wall();
    BakeOptions options = fitted_options(2048);
    const Transfer fitted = bake(scene, options).baked.transfer;
    options.fit = FitMode::vertex;
    const Transfer plain = bake(scene, options).baked.transfer;
    const TraceScene traced(scene);
    const TransportReceivers receivers = without_back_sides(vertex_receivers(scene));
    const SurfaceSamples points = sample_surfaces(traced.surfaces(), receivers, {.count = 800, .seed = 17});
    TracerChoice cpu;
    cpu.backend = Backend::cpu;
    const auto tracer = make_tracer(traced, cpu);
    Transfer truth = zero_transfer(3, 1, points.size());
    trace_receivers(*tracer, points.receivers, receivers_on_surfaces(points.receivers),
                    {.order = 3, .rays = 4096, .seed = 8}, truth);
    const auto error = [&](const Transfer& transfer) {
        double sum = 0;
        for (std::uint32_t s = 0; s < points.size(); ++s) {
            const glm::uvec3 c =
                corner_receivers(traced.surfaces(), receivers, points.positions[s].triangle, false);
            const std::array<float, 3> shares = points.positions[s].shares();
            for (std::size_t k = 0; k < truth.dimension(); ++k) {
                const float d = shares[0] * transfer.vector(c.x)[k] + shares[1] * transfer.vector(c.y)[k] +
                                shares[2] * transfer.vector(c.z)[k] - truth.vector(s)[k];
                sum += static_cast<double>(points.receivers.areas[s] * d * d);
            }
        }
        return std::sqrt(sum);
    };
    EXPECT_LT(error(fitted), 0.9 * error(plain));
}

/// The first vertex at a position may belong only to triangles without area.
TEST(FittedBake, IgnoresFirstVerticesWithoutArea) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 2).build();
    VertexArray& vertices = scene.vertex_arrays[0];
    vertices.positions.insert(vertices.positions.begin(), 3, vertices.positions[0]);
    vertices.normals.insert(vertices.normals.begin(), 3, vertices.normals[0]);
    std::vector<glm::uvec3>& triangles = scene.primitives[0].triangles;
    for (glm::uvec3& t : triangles)
        t += 3u;
    triangles.insert(triangles.begin(), {0, 1, 2});
    const Transfer transfer = bake(scene, fitted_options()).baked.transfer;
    for (std::size_t p = 0; p < transfer.receivers(); ++p) // in the open
        EXPECT_NEAR(static_cast<double>(transfer.vector(p)[0]), kY00, 0.01) << p;
}

TEST(FittedBake, IsDeterministic) {
    const Scene scene = floor_with_wall();
    BakeOptions options = fitted_options();
    options.bounces = 1;
    options.threads = 1;
    const Transfer one = bake(scene, options).baked.transfer;
    options.threads = 3;
    EXPECT_EQ(one.vectors, bake(scene, options).baked.transfer.vectors);
}

// Inside a sphere the gather is its mean over the sphere: R_0 = 1 - a, and every bounce multiplies by rho a.
TEST(FittedBake, BouncesAreAGeometricSeries) {
    constexpr int kRows = 40, kOpen = 10;
    constexpr float kAlbedo = 0.8f;
    const Scene bowl =
        test::painted(SceneBuilder().bowl({1, 2, 3}, 0.5f, kRows, kOpen).build(), glm::vec3(kAlbedo));
    const double a = 1 - (1 - std::cos(std::numbers::pi * kOpen / kRows)) / 2;
    const std::vector<float> areas = receiver_areas(bowl);
    for (const int bounces : {0, 1, 3, kEndlessBounces}) {
        BakeOptions options = fitted_options(1024);
        options.bounces = bounces;
        const Transfer transfer = bake(bowl, options).baked.transfer;
        const std::vector<glm::vec3> lit = exit_radiance(transfer, constant_light(3, glm::vec3(1)));
        double mean = 0, area = 0;
        for (std::size_t p = 0; p < lit.size(); ++p) {
            mean += static_cast<double>(areas[p] * lit[p].x);
            area += static_cast<double>(areas[p]);
        }
        double expected = 0;
        const double q = static_cast<double>(kAlbedo) * a;
        if (bounces == kEndlessBounces)
            expected = (1 - a) / (1 - q);
        else
            for (int b = 0; b <= bounces; ++b)
                expected += (1 - a) * std::pow(q, b);
        EXPECT_NEAR(mean / area, expected, 0.02 * expected) << bounces;
    }
}

// Normals of a coarse bowl send rays below the plane of their triangle: their hits count as light, too.
TEST(FittedBake, IsOneInAWhiteFurnaceOnCoarseSurfaces) {
    const Scene bowl =
        test::painted(SceneBuilder().bowl({0, 0, 0}, 1, 8, 3).build(), glm::vec3(1), /*double_sided=*/true);
    BakeOptions options = fitted_options(512);
    options.bounces = kEndlessBounces;
    const Transfer transfer = bake(bowl, options).baked.transfer;
    const std::vector<float> areas = receiver_areas(bowl);
    const std::vector<glm::vec3> lit = exit_radiance(transfer, constant_light(3, glm::vec3(1)));
    double mean = 0, area = 0;
    for (std::size_t p = 0; p < lit.size(); ++p) {
        mean += static_cast<double>(areas[p] * lit[p].x);
        area += static_cast<double>(areas[p]);
    }
    EXPECT_NEAR(mean / area, 1, 1e-3);
}

/// A lamp at height h over a floor results in 1 / (pi h²) below it, and falls off as h / (pi d³).
TEST(FittedBake, LampsMatchTheirLightAndStayNonnegative) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 16).build();
    PunctualLight lamp;
    lamp.name = "lamp";
    lamp.position = {0.3f, 1, 0};
    scene.lights = {lamp};
    const Transfer transfer = bake(scene, fitted_options()).baked.transfer;
    const std::vector<glm::vec3> lit = exit_radiance(transfer, constant_light(3, glm::vec3(0)));
    const VertexArray& floor = scene.vertex_arrays[0];
    for (std::size_t p = 0; p < lit.size(); ++p) {
        const double d = static_cast<double>(glm::distance(floor.positions[p], lamp.position));
        // A best fit of cells of 0.25 lies h²/6 of the curvature, 3 / pi at the peak, above it there.
        EXPECT_NEAR(static_cast<double>(lit[p].x), 1 / (std::numbers::pi * d * d * d), 0.01);
    }
    // The lamp is so near that its light is a peak between vertices: around it the best fit would be
    // negative.
    scene.lights[0].position = {0.06f, 0.02f, 0.06f};
    for (const glm::vec3& v :
         exit_radiance(bake(scene, fitted_options()).baked.transfer, constant_light(3, glm::vec3(0))))
        EXPECT_GE(v.x, 0);
}

TEST(FittedBake, LightsThinSheetsFromBothSides) {
    Scene sheet = test::painted(SceneBuilder().floor({0, 1, 0}, 1, 4).build(), glm::vec3(0.5f), true);
    sheet.materials[0].transmission.factor = 0.5f;
    BakeOptions options = fitted_options();
    options.bounces = 1;
    // T = (1 - f) X_front + (f c/rho) X_back with f = 0.5, c/rho = 2: under a uniform sky 0.5 + 1.
    for (const glm::vec3& lit :
         exit_radiance(bake(sheet, options).baked.transfer, constant_light(3, glm::vec3(1))))
        EXPECT_NEAR(lit.x, 1.5f, 1e-4f);
}

TEST(FittedBake, UsesNeighborsInsideGeometry) {
    // A box on a floor covers some of its cells: they see nothing.
    SceneBuilder builder;
    builder.floor({0, 0, 0}, 1, 20);
    builder.sphere({0, 0, 0}, 0.35f, 12);
    const Scene scene = builder.build();
    BakeOptions options = fitted_options();
    const BakeResult refilled = bake(scene, options);
    EXPECT_GT(refilled.statistics.receivers.sealed, 0);
    EXPECT_EQ(refilled.statistics.receivers.sealed, refilled.statistics.receivers.refilled);
    options.repairs.inside = Inside::keep;
    const BakeResult kept = bake(scene, options);
    const VertexArray& vertices = scene.vertex_arrays[0];
    bool middle = false;
    for (std::size_t p = 0; p < vertices.size(); ++p)
        if (glm::length(vertices.positions[p]) < 0.01f) {
            middle = true;
            EXPECT_GT(refilled.baked.transfer.vector(p)[0], 0.1f);
            EXPECT_NEAR(kept.baked.transfer.vector(p)[0], 0, 0.02f);
        }
    EXPECT_TRUE(middle);
}

TEST(FittedBake, EstimatesItsNoise) {
    const Scene scene = floor_with_wall();
    std::vector<Transfer> bakes;
    double estimated = 0;
    for (int seed = 0; seed < 4; ++seed) {
        BakeOptions options = fitted_options(512);
        options.seed = static_cast<std::uint64_t>(seed);
        BakeResult result = bake(scene, options);
        estimated += result.statistics.sampling_error / 4;
        bakes.push_back(std::move(result.baked.transfer));
    }
    const std::vector<float> areas = receiver_areas(scene);
    double noise = 0, norm = 0;
    for (std::size_t p = 0; p < areas.size(); ++p)
        for (std::size_t k = 0; k < bakes[0].dimension(); ++k) {
            double mean = 0, squares = 0;
            for (const Transfer& t : bakes) {
                const auto v = static_cast<double>(t.vector(p)[k]);
                mean += v / 4;
                squares += v * v / 4;
            }
            noise += static_cast<double>(areas[p]) * (squares - mean * mean) * 4 / 3;
            norm += static_cast<double>(areas[p]) * mean * mean;
        }
    const double measured = std::sqrt(noise / norm);
    EXPECT_GT(estimated, measured / 2);
    EXPECT_LT(estimated, measured * 2);
}

} // namespace
} // namespace prt
