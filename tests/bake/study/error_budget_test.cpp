// The budget of errors where every cause is known in closed form.

#include "bake/studies/error_budget.h"
#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace prt::test {
namespace {

/// Returns a sky with `radiance` at height y above the horizon, -1..1; its bands are those of the image.
ReferenceLight sky_of(const std::function<float(float y)>& radiance) {
    Image image{8, 180, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.pixels.emplace_back(
                radiance(static_cast<float>(lat_long_direction(image.width, image.height, x, y + 0.5).y)));
    return {.all = DistantLight(image),
            .sky = {},
            .suns = {},
            .sky_bands = project({image}, kMaxOrder),
            .sun_bands = constant_light(kMaxOrder, glm::vec3(0))};
}

ReferenceLight uniform() {
    return sky_of([](float) { return 1.0f; });
}

BandTruncation truncation_of(int order, int bounces = kEndlessBounces) {
    BandTruncation cut{order, bounces, {}};
    cut.factors.fill(1);
    return cut;
}

/// Returns equal values for all points.
std::vector<glm::vec3> all_points(const SurfacePoints& points, float value) {
    return std::vector<glm::vec3>(points.size(), glm::vec3(value));
}

/// A floor under a light.
struct Lit {
    Scene scene;
    TraceScene traced{scene};
    SurfacePoints points;
    ReferenceLight light;
    SurfaceRadiance reference;

    Lit(Scene of, ReferenceLight lit_by, int paths = 64)
        : scene(std::move(of)), points(surface_points(traced, {.count = 1000})), light(std::move(lit_by)),
          reference(traced, points, light, {.paths = paths, .max_paths = paths}) {}
};

Scene open_floor() {
    return SceneBuilder().floor(glm::vec3(0), 2, 8).build();
}

/// Values of the scene's receivers at the points.
std::vector<glm::vec3> at_points(const Lit& lit, const std::vector<float>& values) {
    std::vector<glm::vec3> radiance(values.begin(), values.end());
    return interpolated(lit.points, radiance);
}

TEST(SurfacePoints, AreOnTheirTrianglesAndCoverTheArea) {
    const Scene scene = SceneBuilder().floor(glm::vec3(0), 2, 8).sphere(glm::vec3(0, 3, 0), 1, 12).build();
    const TraceScene traced(scene);
    const SurfacePoints points = surface_points(traced, {.count = 2000});
    double area = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        area += static_cast<double>(points.receivers.areas[p]);
        const glm::vec3& at = points.receivers.positions[p];
        EXPECT_TRUE(std::abs(at.y) < 1e-5f || std::abs(glm::distance(at, glm::vec3(0, 3, 0)) - 1) < 0.05f);
    }
    // Systematic sampling: an area of n points is known to one of them.
    EXPECT_NEAR(area, 16 + 4 * M_PI, 0.02 * (16 + 4 * M_PI)); // the sphere's facets have a little less
}

TEST(SurfacePoints, InsideABoxDoNotCount) {
    // A floor with a closed box on it: points under the box see only the insides of its walls.
    const Scene scene = SceneBuilder().floor(glm::vec3(0), 2, 8).sphere(glm::vec3(0, 0.2f, 0), 1, 16).build();
    const TraceScene traced(scene);
    const SurfacePoints points = surface_points(traced, {.count = 2000});
    for (std::size_t p = 0; p < points.size(); ++p) {
        const glm::vec3& at = points.receivers.positions[p];
        EXPECT_TRUE(at.y != 0 || glm::length(at) > 0.9f) << at.x << ' ' << at.z;
    }
}

TEST(SurfacePoints, QuartersOfTrianglesContainTheirPoints) {
    const Lit lit(SceneBuilder().sphere(glm::vec3(0), 1, 6).build(), uniform(), 1);
    const QuarterCorners quarters = quarter_corners(lit.traced, lit.points);
    for (std::size_t p = 0; p < lit.points.size(); ++p) {
        glm::vec3 sum(0);
        float all = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_GE(quarters.shares[p][i], -1e-5f);
            all += quarters.shares[p][i];
            sum += quarters.shares[p][i] * quarters.corners.receivers.positions[3 * p + i];
        }
        EXPECT_NEAR(all, 1, 1e-5f);
        EXPECT_LT(glm::distance(sum, lit.points.receivers.positions[p]), 1e-5f);
    }
}

TEST(SurfaceRadiance, IsOneEverywhereInAWhiteWorldUnderUniformLight) {
    // Energy: with albedo 1, all bounces and uniform light 1 radiance is 1 in any geometry.
    Scene scene = painted(
        SceneBuilder().floor(glm::vec3(0), 2, 8).bowl(glm::vec3(0, 1, 0), 0.8f, 12, 3).build(), glm::vec3(1),
        true); // backs of single-sided surfaces are black
    const Lit lit(std::move(scene), uniform(), 256);
    double truth = 0, bands = 0, area = 0;
    const std::vector<glm::vec3> held = lit.reference.under(truncation_of(1), 0);
    for (std::size_t p = 0; p < lit.points.size(); ++p) {
        const auto a = static_cast<double>(lit.points.receivers.areas[p]);
        area += a;
        truth += a * static_cast<double>(lit.reference.truth(0)[p].x);
        bands += a * static_cast<double>(held[p].x);
    }
    // Deviation of a path is below 1, of the mean of 256 000 of them below 0.002.
    EXPECT_NEAR(truth / area, 1, 0.01);
    EXPECT_NEAR(bands / area, 1, 0.01);
}

TEST(ErrorBudget, BandErrorIsTheTruncationErrorOfACap) {
    // Light from less than 60 degrees off the normal: an open floor receives 1 - cos² 60° = 0.75 of it, and N
    // bands produce the value of the clamped cosine's coefficients.
    const Lit lit(open_floor(), sky_of([](float y) { return y > 0.5f ? 1.0f : 0.0f; }), 1024);
    for (const int order : {1, 2, 3, 5, 7}) {
        std::vector<double> lobe(static_cast<std::size_t>(order * order));
        clamped_cosine_lobe(order, glm::dvec3(0, 1, 0), lobe);
        double held = 0;
        for (std::size_t i = 0; i < lobe.size(); ++i)
            held += lobe[i] * static_cast<double>(lit.light.sky_bands.coefficients[i].x);
        const SquaredError error = light_error(lit.points, lit.reference, truncation_of(order));
        EXPECT_NEAR(error.value, std::pow(held / 0.75 - 1, 2), 3e-4) << order;
        EXPECT_LE(error.low, error.value);
        EXPECT_GE(error.high, error.value);
    }
}

TEST(ErrorBudget, BounceErrorIsTheMissingLight) {
    // Each point of a bowl that is closed except for a hole reflects light: with albedo 1 all bounces give 1,
    // and no bounces give only direct light of the sky.
    const Lit lit(painted(SceneBuilder().bowl(glm::vec3(0), 1, 24, 6).build(), glm::vec3(1)), uniform(), 256);
    const std::vector<glm::vec3> direct = lit.reference.under(truncation_of(1, 0), 0);
    double wanted = 0, area = 0;
    for (std::size_t p = 0; p < lit.points.size(); ++p) {
        const auto a = static_cast<double>(lit.points.receivers.areas[p]);
        wanted += a * std::pow(1 - static_cast<double>(direct[p].x), 2);
        area += a;
    }
    const double error = bounces_error(lit.points, lit.reference, truncation_of(1, 0)).value;
    EXPECT_GT(error, 0.2);
    EXPECT_NEAR(error, wanted / area, 0.02); // noise of single points in `wanted`: 1/4 over 256 paths
    EXPECT_LT(bounces_error(lit.points, lit.reference, truncation_of(1, 1)).value, error);
    EXPECT_EQ(bounces_error(lit.points, lit.reference, truncation_of(1)).value, 0);
}

/// Vertex values of 1 with errors of known kinds.
struct Painted {
    std::vector<float> baked, repeated, shipped;
};

Painted painted_values(std::size_t receivers, float second_difference, float noise, float coding) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Painted values;
    for (std::size_t p = 0; p < receivers; ++p) {
        values.baked.push_back(1 + second_difference + noise * normal(random));
        values.repeated.push_back(1 + second_difference + noise * normal(random));
        values.shipped.push_back(values.baked.back() + coding * normal(random));
    }
    return values;
}

ErrorBudget budget_of(const Lit& lit, const Painted& values, bool alike) {
    InterpolatedRadiance radiance{at_points(lit, values.baked), at_points(lit, values.repeated),
                                  at_points(lit, values.shipped), alike};
    return error_budget(lit.points, lit.reference, truncation_of(1), radiance);
}

TEST(ErrorBudget, FindsEachCauseOfAPaintedFloor) {
    const Lit lit(SceneBuilder().floor(glm::vec3(0), 2, 40).build(), uniform());
    const Painted values = painted_values(lit.scene.receivers(), 0.05f, 0.08f, 0.03f);
    for (const bool alike : {true, false}) {
        const ErrorBudget budget = budget_of(lit, values, alike);
        EXPECT_NEAR(budget.of(ErrorCause::light).value, 0, 1e-5);
        EXPECT_NEAR(budget.of(ErrorCause::bounces).value, 0, 1e-12);
        // Independent values of three corners are interpolated: the mean of the sum of squared weights is
        // 1/2. A thousand points have an error of 5 % in a squared normal deviate's mean, and products with
        // the second differences account for the rest.
        EXPECT_NEAR(budget.of(ErrorCause::vertices).value, 0.0025, 6e-4);
        EXPECT_NEAR(budget.of(ErrorCause::rays).value, 0.0032, 6e-4);
        EXPECT_NEAR(budget.of(ErrorCause::bytes).value, 0.00045, 6e-5);
        EXPECT_NEAR(budget.total.value, 0.00615, 7e-4);
        EXPECT_NEAR(budget.sum() + budget.together.value, budget.total.value, 1e-12);
    }
}

/// Under uniform light, eyes adapt to a tenth of it: contrast errors are those of luminance over 1.1.
TEST(ErrorBudget, ContrastErrorIsRelativeToLuminance) {
    const Lit lit(SceneBuilder().floor(glm::vec3(0), 2, 40).build(), uniform());
    const auto error = [&](const glm::vec3& by) {
        const std::vector<glm::vec3> off(lit.points.size(), glm::vec3(1) + by);
        return error_budget(lit.points, lit.reference, truncation_of(1), {off, off, off},
                            BudgetMeasure::visible)
            .total.root();
    };
    EXPECT_NEAR(error(glm::vec3(0.2f)), 0.2 / 1.1, 1e-4);
    EXPECT_NEAR(error({0, 0.2f, 0}), std::sqrt(0.7152) * 0.2 / 1.1, 1e-4);
}

/// A black bowl is darker at larger depth: an equal error is more visible there.
TEST(ErrorBudget, ContrastErrorCountsDimLight) {
    const Lit lit(painted(SceneBuilder().bowl(glm::vec3(0), 1, 24, 6).build(), glm::vec3(0)), uniform(),
                  2048);
    double expected = 0, area = 0, logarithms = 0;
    std::vector<double> light(lit.points.size());
    for (std::size_t p = 0; p < light.size(); ++p) {
        const auto a = static_cast<double>(lit.points.receivers.areas[p]);
        light[p] = 0.5 * static_cast<double>(lit.reference.truth(0)[p].x + lit.reference.truth(1)[p].x);
        logarithms += a * std::log(light[p]);
        area += a;
    }
    std::vector<glm::vec3> off;
    for (std::size_t p = 0; p < light.size(); ++p) {
        const double seen = light[p] + 0.1 * std::exp(logarithms / area);
        expected += static_cast<double>(lit.points.receivers.areas[p]) / area * std::pow(0.2 / seen, 2);
        off.emplace_back(static_cast<float>(light[p] + 0.2));
    }
    const ErrorBudget budget =
        error_budget(lit.points, lit.reference, truncation_of(1), {off, off, off}, BudgetMeasure::visible);
    EXPECT_NEAR(budget.total.root(), std::sqrt(expected), 0.02 * std::sqrt(expected));
}

TEST(ErrorBudget, IsZeroWithoutErrors) {
    const Lit lit(open_floor(), uniform());
    const std::vector<glm::vec3> one = all_points(lit.points, 1);
    const ErrorBudget budget = error_budget(lit.points, lit.reference, truncation_of(3), {one, one, one});
    EXPECT_NEAR(budget.total.value, 0, 1e-5);
    EXPECT_EQ(budget.of(ErrorCause::rays).value, 0);
    EXPECT_EQ(budget.of(ErrorCause::bytes).value, 0);
    EXPECT_NEAR(budget.of(ErrorCause::vertices).value, 0, 1e-5);
}

TEST(ErrorBudget, ExcludesSeparateSuns) {
    // Only a separate sun: transfer is not used, and errors are relative to the light of the sun.
    ReferenceLight light = uniform();
    light.all = DistantLight(Image{1, 1, {glm::vec3(0)}}, {{glm::vec3(0, 1, 0), glm::vec3(2)}});
    light.sky.emplace(Image{1, 1, {glm::vec3(0)}});
    light.suns = {{glm::vec3(0, 1, 0), glm::vec3(2), 0}};
    light.sky_bands = constant_light(kMaxOrder, glm::vec3(0));
    light.sun_bands = as_light(light.suns, kMaxOrder);
    const Lit lit(open_floor(), std::move(light));
    for (const glm::vec3& sun : lit.reference.suns())
        EXPECT_NEAR(sun.x, 2 / M_PI, 1e-5);
    const auto off = all_points(lit.points, static_cast<float>(0.1 * 2 / M_PI));
    const ErrorBudget budget = error_budget(lit.points, lit.reference, truncation_of(4), {off, off, off});
    EXPECT_NEAR(budget.total.root(), 0.1, 1e-4);
    EXPECT_NEAR(budget.of(ErrorCause::light).value, 0, 1e-9);
}

TEST(ErrorBudget, SplitTrianglesHaveNoErrorInUniformLight) {
    // If the reference at corners and points is one function, light has no error however triangles are split:
    // an open floor under one sky.
    const Lit lit(open_floor(), uniform());
    const QuarterCorners quarters = quarter_corners(lit.traced, lit.points);
    const SurfaceRadiance corners(lit.traced, quarters.corners, lit.light, {.paths = 64, .max_paths = 64});
    EXPECT_NEAR(split_error(lit.points, lit.reference, quarters, corners, truncation_of(2)).value, 0, 1e-4);
}

TEST(SurfaceRadiance, DoesNotDependOnThreads) {
    const Scene scene = SceneBuilder().floor(glm::vec3(0), 2, 8).sphere(glm::vec3(0, 1, 0), 0.8f, 8).build();
    const TraceScene traced(scene);
    const SurfacePoints points = surface_points(traced, {.count = 100});
    const ReferenceLight light = uniform();
    const SurfaceRadiance one(traced, points, light, {.paths = 32, .max_paths = 64, .threads = 1}),
        three(traced, points, light, {.paths = 32, .max_paths = 64, .threads = 3});
    EXPECT_TRUE(std::ranges::equal(one.truth(1), three.truth(1)));
    EXPECT_EQ(one.under(truncation_of(4), 0), three.under(truncation_of(4), 0));
}

} // namespace
} // namespace prt::test
