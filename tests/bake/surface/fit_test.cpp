#include "surface/fit_choice.h"
#include "surface/fit_solver.h"

#include "prt/bake.h"
#include "prt/sh.h"
#include "prt/trace_receivers.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace prt {
namespace {

using test::SceneBuilder;

/// A scene's surface, its samples, and the equations of a fit to them.
struct Fitted {
    explicit Fitted(Scene of, std::size_t count = 4000)
        : scene(std::move(of)), traced(scene), receivers(without_back_sides(vertex_receivers(scene))),
          samples(sample_surfaces(traced.surfaces(), receivers, {.count = count, .seed = 3})),
          equations(fit_equations(traced.surfaces(), receivers, samples,
                                  alike_receivers(traced.surfaces(), receivers))) {}

    /// The values of receivers of a function over space, and what bending costs.
    std::vector<float> fit(const std::function<double(const glm::vec3&)>& f, float bend_weight) const {
        std::vector<float> at_samples;
        for (const glm::vec3& p : samples.receivers.positions)
            at_samples.push_back(static_cast<float>(f(p)));
        std::vector<float> x(equations.unknowns), values(receivers.receivers.size());
        add_samples(equations, 0, std::span<const float>(at_samples), 1, std::span(x));
        FitSolver(equations, std::vector<float>(equations.bends.size(), bend_weight)).solve(x, 1, 2);
        spread_unknowns(equations, std::span<const float>(x), 1, std::span(values));
        return values;
    }
    const std::vector<glm::vec3>& positions() const { return receivers.receivers.positions; }

    Scene scene;
    TraceScene traced;
    TransportReceivers receivers;
    SurfaceSamples samples;
    FitEquations equations;
};

/// A square of cells that are shifted about.
Scene uneven_floor(int cells) {
    return SceneBuilder()
        .floor({0, 0, 0}, 1, cells)
        .transform([](const glm::vec3& p) {
            return glm::vec3(p.x + 0.07f * std::sin(9 * p.z), 0, p.z + 0.07f * std::sin(11 * p.x));
        })
        .build();
}

TEST(SurfaceSamples, StandForTheWholeSurfaceAndLieOnIt) {
    const Fitted floor(SceneBuilder().floor({0, 0, 0}, 1, 3).floor({5, 1, 0}, 0.01f, 4).build(), 500);
    double area = 0;
    std::vector<int> of_triangle(floor.traced.surfaces().triangles());
    for (std::size_t s = 0; s < floor.samples.size(); ++s) {
        const glm::vec3& p = floor.samples.receivers.positions[s];
        area += static_cast<double>(floor.samples.receivers.areas[s]);
        EXPECT_FLOAT_EQ(p.y, p.x > 3 ? 1.0f : 0.0f);
        for (const float share : floor.samples.places[s].shares())
            EXPECT_TRUE(share >= 0 && share <= 1);
        ++of_triangle[floor.samples.places[s].triangle];
    }
    EXPECT_NEAR(area, 4 + 0.0004, 1e-5);
    for (const int count : of_triangle)
        EXPECT_GE(count, 1); // the small ones, too
    EXPECT_NEAR(static_cast<double>(floor.samples.size()), 500, 20);
}

TEST(SurfaceSamples, LayersTakeEachSampleOnce) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 5).build();
    const TraceScene traced(scene);
    const SurfaceSamples samples =
        sample_surfaces(traced.surfaces(), without_back_sides(vertex_receivers(scene)),
                        {.count = 203, .layers = 4, .seed = 1});
    std::size_t sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Receivers layer = samples.layer(k);
        for (std::size_t g = 0; g < layer.size(); ++g)
            EXPECT_EQ(layer.positions[g], samples.receivers.positions[4 * g + k]);
        sum += layer.size();
    }
    EXPECT_EQ(sum, samples.size());
}

TEST(Bend, IsZeroWhereAFunctionIsLinearOverTheUnfoldedTriangles) {
    // Folded by 90 degrees along z: the distance from the fold, seen along the surface.
    const std::vector<FitTriangle> triangles = {
        {{0, 1, 2}, {{{0, 0, 0}, {0, 0, 1}, {-2, 0, 0.3}}}},
        {{1, 0, 3}, {{{0, 0, 1}, {0, 0, 0}, {0, 0.5, 0.8}}}},
    };
    const std::vector<Bend> bends = bends_of(triangles);
    ASSERT_EQ(bends.size(), 1);
    const auto bend = [&](const std::array<double, 4>& x) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i)
            sum += static_cast<double>(bends[0].factors[i]) * x[bends[0].unknowns[i]];
        return sum;
    };
    EXPECT_NEAR(bend({1, 1, 1, 1}), 0, 1e-6);
    EXPECT_NEAR(bend({0, 0, -2, 0.5}), 0, 1e-6);  // across
    EXPECT_NEAR(bend({0, 1, 0.3, 0.8}), 0, 1e-6); // along
    EXPECT_FLOAT_EQ(bends[0].area, 1 + 0.25f);
    // Heights 2 and 0.5: their harmonic mean over each, times a bend of 1 in either slope.
    EXPECT_NEAR(bend({0, 0, 2, 0}), 0.8, 1e-6);
    EXPECT_NEAR(bend({0, 0, 0, 0.5}), 0.8, 1e-6);
}

TEST(Bend, IsOfEdgesThatTwoTrianglesShare) {
    const std::array<glm::dvec3, 3> at = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    EXPECT_EQ(bends_of(std::vector<FitTriangle>{{{0, 1, 2}, at}}).size(), 0);
    EXPECT_EQ(bends_of(std::vector<FitTriangle>{{{0, 1, 2}, at}, {{1, 0, 3}, at}, {{0, 1, 4}, at}}).size(),
              0);
    EXPECT_EQ(bends_of(std::vector<FitTriangle>{{{0, 1, 2}, at}, {{0, 1, 2}, at}}).size(), 0); // duplicated
}

TEST(Bend, IsNotThatOfEdgesWithoutLength) {
    // Beside the pole of a sphere whose vertices are not quite in one place: a denormal apart.
    const std::vector<FitTriangle> triangles = {{{0, 1, 2}, {{{0, 0, 0}, {3.3e-41, 0, 0}, {1, 1, 0}}}},
                                                {{1, 0, 3}, {{{3.3e-41, 0, 0}, {0, 0, 0}, {1, -1, 0}}}}};
    EXPECT_EQ(bends_of(triangles).size(), 0);
}

class FitWeight : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Weights, FitWeight, testing::Values(0.0f, 0.003f, 5.0f));

TEST_P(FitWeight, IsExactForLinearFunctions) {
    const Fitted floor(uneven_floor(7));
    const auto f = [](const glm::vec3& p) {
        return 3 + 2 * static_cast<double>(p.x) - static_cast<double>(p.z);
    };
    const std::vector<float> values = floor.fit(f, GetParam());
    for (std::size_t p = 0; p < values.size(); ++p) // but for the slope's price, 1e-5, at the ends
        EXPECT_NEAR(static_cast<double>(values[p]), f(floor.positions()[p]), 3e-4);
}

// On an even mesh the best continuous function that is linear between nodes lies h²/6 below x² at every node:
// then what is left, (x - a)(b - x) - h²/6, is orthogonal to all hats.
TEST(Fit, OfAParabolaIsBestOnAverage) {
    constexpr int kCells = 12;
    const Fitted floor(SceneBuilder().floor({0, 0, 0}, 1, kCells).build(), 60000);
    const std::vector<float> values =
        floor.fit([](const glm::vec3& p) { return static_cast<double>(p.x * p.x); }, 0);
    const double h = 2.0 / kCells;
    int inside = 0;
    for (std::size_t p = 0; p < values.size(); ++p) {
        const glm::dvec3 at(floor.positions()[p]);
        if (std::max(std::abs(at.x), std::abs(at.z)) > 0.6)
            continue;
        EXPECT_NEAR(static_cast<double>(values[p]) - at.x * at.x, -h * h / 6, 0.1 * h * h / 6);
        ++inside;
    }
    EXPECT_GT(inside, 100);
}

/// Mean squared error over a square of what is interpolated between `values`, by many points.
double squared_error(const Fitted& floor, std::span<const float> values,
                     const std::function<double(const glm::vec3&)>& f) {
    const SurfaceSamples points =
        sample_surfaces(floor.traced.surfaces(), floor.receivers, {.count = 40000, .seed = 99});
    double sum = 0;
    for (std::size_t s = 0; s < points.size(); ++s) {
        const glm::uvec3 c =
            corner_receivers(floor.traced.surfaces(), floor.receivers, points.places[s].triangle, false);
        const std::array<float, 3> shares = points.places[s].shares();
        double here = -f(points.receivers.positions[s]);
        for (int i = 0; i < 3; ++i)
            here += static_cast<double>(shares[static_cast<std::size_t>(i)] * values[c[i]]);
        sum += here * here * static_cast<double>(points.receivers.areas[s]);
    }
    return sum;
}

TEST(Fit, OfAStepErrsLessThanItsValuesAtVertices) {
    const Fitted floor(uneven_floor(9), 20000);
    const auto step = [](const glm::vec3& p) { return p.x + 0.3f * p.z > 0.1f ? 1.0 : 0.0; };
    std::vector<float> at_vertices;
    for (const glm::vec3& p : floor.positions())
        at_vertices.push_back(static_cast<float>(step(p)));
    EXPECT_LT(squared_error(floor, floor.fit(step, 0.003f), step),
              0.85 * squared_error(floor, at_vertices, step));
}

TEST(Fit, OfAConstantIsExactOnAnyMesh) {
    SceneBuilder builder;
    builder.sphere({4, 0, 0}, 1, 6).floor({0, 0, 0}, 1, 3);
    builder.floor({0, 0, 0}, 1, 3);                                          // duplicated
    builder.triangle({0, 3, 0}, {1, 3, 0}, {0, 3, 1});                       // alone
    builder.triangle({-1, 4, 0}, {1, 4, 1e-6f}, {1, 4, 0});                  // a needle
    builder.triangle({0, 5, 0}, {0, 5, 0}, {0, 5, 0});                       // a point
    builder.triangle({0, 0, 0}, {0, 1, 0}, {2.0f / 3 - 1 + 1.0f / 3, 1, 0}); // a third on an edge, and a line
    const Fitted mesh(builder.build(), 600);
    for (const float weight : {0.0f, 0.003f, 5.0f}) {
        const std::vector<float> values = mesh.fit([](const glm::vec3&) { return 0.7; }, weight);
        const std::vector<std::uint32_t> lit = receivers_on_surfaces(mesh.receivers.receivers);
        std::vector<bool> on_surface(values.size());
        for (const std::uint32_t p : lit)
            on_surface[p] = true;
        for (std::size_t p = 0; p < values.size(); ++p)
            // Rounding of floats, 6e-8, over what a lone sample ties corners together with, 1e-5.
            EXPECT_NEAR(values[p], on_surface[p] ? 0.7f : 0.0f, 6e-3f) << p << " " << weight;
    }
}

TEST(Fit, DoesNotDependOnThreads) {
    const Fitted floor(uneven_floor(9));
    std::vector<float> one(floor.equations.unknowns * 19), many;
    std::mt19937 random(1);
    for (float& v : one)
        v = std::uniform_real_distribution<float>(-1, 1)(random);
    many = one;
    const FitSolver solver(floor.equations, std::vector<float>(floor.equations.bends.size(), 0.1f));
    solver.solve(one, 19, 1);
    solver.solve(many, 19, 5);
    EXPECT_EQ(one, many);
}

TEST(FitChoice, IsWhatErrsLess) {
    EXPECT_TRUE(choose_fit({.between = 0.05, .sampling = 0.002}, 1024).better);
    EXPECT_FALSE(choose_fit({.between = 0.005, .sampling = 0.02}, 1024).better);
    EXPECT_FALSE(choose_fit({}, 1024).better); // nothing errs: as it was
    EXPECT_FALSE(choose_fit({.between = 1e-7}, 1024).better);
    // The clearer it is, the more samples, of no fewer than 128 rays.
    EXPECT_EQ(choose_fit({.between = 0.05, .sampling = 0.001}, 4096).samples, 16);
    EXPECT_EQ(choose_fit({.between = 0.05, .sampling = 0.001}, 1024).samples, 8);
    EXPECT_EQ(choose_fit({.between = 0.01, .sampling = 0.05}, 4096).samples, 2);
}

BakeOptions fitted_options(int rays = 256) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.fit = FitMode::surface;
    return options;
}

TEST(FittedBake, IsTheLobeWhereNothingShadows) {
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

/// A floor of large cells that a wall stands on, off their edges.
Scene floor_with_wall() {
    return test::join(
        {SceneBuilder().floor({0, 0, 0}, 1, 8).build(),
         test::painted(SceneBuilder().quad({-1, 0, 0.1f}, {1, 0, 0.1f}, {1, 1, 0.1f}, {-1, 1, 0.1f}).build(),
                       glm::vec3(0.5f), true)});
}

/// Half of the hemisphere is behind the wall where it is near; far from it, next to nothing.
TEST(FittedBake, ErrsLessBetweenVerticesThanOneAtVertices) {
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
                corner_receivers(traced.surfaces(), receivers, points.places[s].triangle, false);
            const std::array<float, 3> shares = points.places[s].shares();
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

/// The first vertex at a place may belong to triangles without area alone.
TEST(FittedBake, HasNoUseForTheFirstOfVerticesWhereThatHasNoArea) {
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

// Normals of a coarse bowl send rays below the plane of their triangle: what these meet is light, too.
TEST(FittedBake, OfAWhiteFurnaceIsOneOnCoarseHollowSurfaces) {
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

/// A lamp h over a floor gives 1 / (pi h²) below it, and falls as h / (pi d³).
TEST(FittedBake, LampsLightAsTheyDoAndNeverTakeLightAway) {
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
    // So near that its light is a peak between vertices: round it the best fit would be below zero.
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

TEST(FittedBake, TakesTheLightOfNeighboursInsideGeometry) {
    // A box on a floor whose cells it covers in the middle: nothing sees these.
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

TEST(FittedBake, KnowsItsNoise) {
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
