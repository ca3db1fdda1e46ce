// Tests least-squares fits of vertex values to samples over the surface.

#include "bake/surface_fit/fit_choice.h"
#include "bake/surface_fit/fit_solver.h"

#include "bake/scene/trace_scene.h"
#include "support/scene_builder.h"
#include "uneven_floor.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace prt {
namespace {

using test::SceneBuilder;
using test::uneven_floor;

/// A scene's surface, its samples, and the equations of a fit to them.
struct Fitted {
    explicit Fitted(Scene of, std::size_t count = 4000)
        : scene(std::move(of)), traced(scene), receivers(without_back_sides(vertex_receivers(scene))),
          samples(sample_surfaces(traced.surfaces(), receivers, {.count = count, .seed = 3})),
          equations(fit_equations(traced.surfaces(), receivers, samples,
                                  alike_receivers(traced.surfaces(), receivers))) {}

    /// Fits a function over space to the receivers, with a weight on second differences.
    std::vector<float> fit(const std::function<double(const glm::vec3&)>& f, float smoothness_weight) const {
        std::vector<float> at_samples;
        for (const glm::vec3& p : samples.receivers.positions)
            at_samples.push_back(static_cast<float>(f(p)));
        std::vector<float> x(equations.unknowns), values(receivers.receivers.size());
        add_samples(equations, 0, std::span<const float>(at_samples), 1, std::span(x));
        FitSolver(equations, std::vector<float>(equations.second_differences.size(), smoothness_weight))
            .solve(x, 1, 2);
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

TEST(SurfaceSamples, CoverTheSurface) {
    const Fitted floor(SceneBuilder().floor({0, 0, 0}, 1, 3).floor({5, 1, 0}, 0.01f, 4).build(), 500);
    double area = 0;
    std::vector<int> of_triangle(floor.traced.surfaces().triangles());
    for (std::size_t s = 0; s < floor.samples.size(); ++s) {
        const glm::vec3& p = floor.samples.receivers.positions[s];
        area += static_cast<double>(floor.samples.receivers.areas[s]);
        EXPECT_FLOAT_EQ(p.y, p.x > 3 ? 1.0f : 0.0f);
        for (const float share : floor.samples.positions[s].shares())
            EXPECT_TRUE(share >= 0 && share <= 1);
        ++of_triangle[floor.samples.positions[s].triangle];
    }
    EXPECT_NEAR(area, 4 + 0.0004, 1e-5);
    for (const int count : of_triangle)
        EXPECT_GE(count, 1); // the small ones, too
    EXPECT_NEAR(static_cast<double>(floor.samples.size()), 500, 20);
}

TEST(SurfaceSamples, LayersContainEachSampleOnce) {
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

TEST(SecondDifference, IsZeroForLinearFunctionsOverUnfoldedTriangles) {
    // Folded by 90 degrees along z: the distance from the fold, seen along the surface.
    const std::vector<FitTriangle> triangles = {
        {{0, 1, 2}, {{{0, 0, 0}, {0, 0, 1}, {-2, 0, 0.3}}}},
        {{1, 0, 3}, {{{0, 0, 1}, {0, 0, 0}, {0, 0.5, 0.8}}}},
    };
    const std::vector<SecondDifference> second_differences = second_differences_of(triangles);
    ASSERT_EQ(second_differences.size(), 1);
    const auto second_difference = [&](const std::array<double, 4>& x) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i)
            sum +=
                static_cast<double>(second_differences[0].factors[i]) * x[second_differences[0].unknowns[i]];
        return sum;
    };
    EXPECT_NEAR(second_difference({1, 1, 1, 1}), 0, 1e-6);
    EXPECT_NEAR(second_difference({0, 0, -2, 0.5}), 0, 1e-6);  // across
    EXPECT_NEAR(second_difference({0, 1, 0.3, 0.8}), 0, 1e-6); // along
    EXPECT_FLOAT_EQ(second_differences[0].area, 1 + 0.25f);
    // Heights 2 and 0.5: their harmonic mean over each, times a bend of 1 in either slope.
    EXPECT_NEAR(second_difference({0, 0, 2, 0}), 0.8, 1e-6);
    EXPECT_NEAR(second_difference({0, 0, 0, 0.5}), 0.8, 1e-6);
}

TEST(SecondDifference, IsDefinedForEdgesOfTwoTriangles) {
    const std::array<glm::dvec3, 3> at = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    EXPECT_EQ(second_differences_of(std::vector<FitTriangle>{{{0, 1, 2}, at}}).size(), 0);
    EXPECT_EQ(
        second_differences_of(std::vector<FitTriangle>{{{0, 1, 2}, at}, {{1, 0, 3}, at}, {{0, 1, 4}, at}})
            .size(),
        0);
    EXPECT_EQ(second_differences_of(std::vector<FitTriangle>{{{0, 1, 2}, at}, {{0, 1, 2}, at}}).size(),
              0); // duplicated
}

TEST(SecondDifference, IgnoresEdgesWithoutLength) {
    // At the pole of a sphere whose vertices are not exactly equal: they differ by a denormal.
    const std::vector<FitTriangle> triangles = {{{0, 1, 2}, {{{0, 0, 0}, {3.3e-41, 0, 0}, {1, 1, 0}}}},
                                                {{1, 0, 3}, {{{3.3e-41, 0, 0}, {0, 0, 0}, {1, -1, 0}}}}};
    EXPECT_EQ(second_differences_of(triangles).size(), 0);
}

class FitWeight : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Weights, FitWeight, testing::Values(0.0f, 0.003f, 5.0f));

TEST_P(FitWeight, IsExactForLinearFunctions) {
    const Fitted floor(uneven_floor(7));
    const auto f = [](const glm::vec3& p) {
        return 3 + 2 * static_cast<double>(p.x) - static_cast<double>(p.z);
    };
    const std::vector<float> values = floor.fit(f, GetParam());
    // except for the smoothness cost of the slope, 1e-5, at the ends
    for (std::size_t p = 0; p < values.size(); ++p)
        EXPECT_NEAR(static_cast<double>(values[p]), f(floor.positions()[p]), 3e-4);
}

// On an even mesh the best continuous piecewise linear function is h²/6 below x² at every node: the residual,
// (x - a)(b - x) - h²/6, is orthogonal to all hat functions.
TEST(Fit, HasTheLeastSquaresErrorForAParabola) {
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

/// Returns the mean squared error over a square of the interpolated `values`, by many points.
double squared_error(const Fitted& floor, std::span<const float> values,
                     const std::function<double(const glm::vec3&)>& f) {
    const SurfaceSamples points =
        sample_surfaces(floor.traced.surfaces(), floor.receivers, {.count = 40000, .seed = 99});
    double sum = 0;
    for (std::size_t s = 0; s < points.size(); ++s) {
        const glm::uvec3 c =
            corner_receivers(floor.traced.surfaces(), floor.receivers, points.positions[s].triangle, false);
        const std::array<float, 3> shares = points.positions[s].shares();
        double here = -f(points.receivers.positions[s]);
        for (int i = 0; i < 3; ++i)
            here += static_cast<double>(shares[static_cast<std::size_t>(i)] * values[c[i]]);
        sum += here * here * static_cast<double>(points.receivers.areas[s]);
    }
    return sum;
}

TEST(Fit, HasLessErrorThanVertexValuesForAStep) {
    const Fitted floor(uneven_floor(9), 20000);
    const auto step = [](const glm::vec3& p) { return p.x + 0.3f * p.z > 0.1f ? 1.0 : 0.0; };
    std::vector<float> at_vertices;
    for (const glm::vec3& p : floor.positions())
        at_vertices.push_back(static_cast<float>(step(p)));
    EXPECT_LT(squared_error(floor, floor.fit(step, 0.003f), step),
              0.85 * squared_error(floor, at_vertices, step));
}

TEST(Fit, IsExactForConstants) {
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
            // Rounding of floats, 6e-8, divided by the weight with which a single sample couples corners,
            // 1e-5.
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
    const FitSolver solver(floor.equations,
                           std::vector<float>(floor.equations.second_differences.size(), 0.1f));
    solver.solve(one, 19, 1);
    solver.solve(many, 19, 5);
    EXPECT_EQ(one, many);
}

TEST(FitChoice, SelectsTheLowerError) {
    EXPECT_TRUE(choose_fit({.between = 0.05, .sampling = 0.002}, 1024, false).better);
    EXPECT_FALSE(choose_fit({.between = 0.005, .sampling = 0.02}, 1024, false).better);
    EXPECT_FALSE(choose_fit({}, 1024, false).better); // no error: the choice does not change
    EXPECT_FALSE(choose_fit({.between = 1e-7}, 1024, false).better);
    // The clearer it is, the more samples, of no fewer than 128 rays.
    EXPECT_TRUE(choose_fit({.between = 0.02, .sampling = 0.014}, 1024, false).better);
    EXPECT_FALSE(choose_fit({.between = 0.02, .sampling = 0.014}, 1024, true).better); // the filter is
    EXPECT_EQ(choose_fit({.between = 0.05, .sampling = 0.001}, 4096, false).samples, 16);
    EXPECT_EQ(choose_fit({.between = 0.05, .sampling = 0.001}, 1024, false).samples, 8);
    EXPECT_EQ(choose_fit({.between = 0.01, .sampling = 0.05}, 4096, false).samples, 2);
}

} // namespace
} // namespace prt
