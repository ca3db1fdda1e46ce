// Errors that a bake reports, against closed forms.

#include "prt/bake/bake.h"
#include "prt/core/sh_basis.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

BakeOptions measured(int order, int rays, int bounces = 0) {
    BakeOptions options;
    options.order = order;
    options.rays = rays;
    options.bounces = bounces;
    options.tracer.backend = Backend::cpu;
    return options;
}

BakeErrors errors_of(const Scene& scene, const BakeOptions& options) {
    return bake(scene, options, {}, MeasureErrors::yes).errors.value();
}

/// Relative L2 over the triangles of a primitive of interpolating `truth` linearly, by midpoints of small
/// triangles.
double interpolation_error(const Scene& scene, std::size_t primitive,
                           const std::function<double(const glm::dvec3&)>& truth) {
    constexpr int kSteps = 60;
    const VertexArray& vertices = scene.vertex_arrays[scene.primitives[primitive].vertices];
    double error = 0, norm = 0;
    for (const glm::uvec3& t : scene.primitives[primitive].triangles) {
        const glm::dvec3 a(vertices.positions[t.x]), b(vertices.positions[t.y]), c(vertices.positions[t.z]);
        const double area = glm::length(glm::cross(b - a, c - a));
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; i + j < kSteps; ++j) {
                const double u = (i + 1.0 / 3) / kSteps, v = (j + 1.0 / 3) / kSteps;
                const double here = truth(a + u * (b - a) + v * (c - a)),
                             between = (1 - u - v) * truth(a) + u * truth(b) + v * truth(c);
                error += area * (between - here) * (between - here);
                norm += area * here * here;
            }
    }
    return std::sqrt(error / norm);
}

/// E / pi of a point light of intensity 1.
double lit_by_point(const glm::dvec3& light, const glm::dvec3& p) {
    const glm::dvec3 to = light - p;
    return to.y / (std::numbers::pi * std::pow(glm::length(to), 3));
}

TEST(BakeErrors, EqualTheInterpolationErrorOfALamp) {
    Scene scene = test::join(
        {SceneBuilder().floor({0, 0, 0}, 2, 2).build(), SceneBuilder().floor({6, 0, 0}, 2, 24).build()});
    PunctualLight light;
    light.name = "lamp";
    light.position = {1, 1.5f, 0.3f};
    scene.lights = {light};
    const BakeErrors errors = errors_of(scene, measured(2, 64));
    const auto truth = [&](const glm::dvec3& p) { return lit_by_point(glm::dvec3(light.position), p); };
    ASSERT_EQ(errors.nodes.size(), 2u);
    const double coarse = interpolation_error(scene, 0, truth), fine = interpolation_error(scene, 1, truth);
    EXPECT_GT(coarse, 0.1);
    EXPECT_LT(fine, 0.01);
    EXPECT_NEAR(errors.nodes[0].lamps.relative_l2, coarse, 0.1 * coarse);
    EXPECT_NEAR(errors.nodes[1].lamps.relative_l2, fine, 0.3 * fine);
    ASSERT_EQ(errors.each_lamp.size(), 1u);
    EXPECT_EQ(errors.each_lamp[0].name, "lamp");
    EXPECT_NEAR(errors.each_lamp[0].error.relative_l2, errors.lamps.relative_l2, 1e-9);
    // Both floors see all of the sky, everywhere: vertices are exact, points too.
    EXPECT_LT(errors.sky.relative_l2, 0.01);
}

/// A floor at the foot of a long wall of height 1 sees (1 + x / sqrt(x² + 1)) / 2 of a uniform sky.
TEST(BakeErrors, EqualTheInterpolationErrorOfASky) {
    const Scene wall = SceneBuilder().quad({0, 0, 1000}, {0, 0, -1000}, {0, 1, -1000}, {0, 1, 1000}).build();
    for (const int cells : {2, 4}) {
        const Scene scene = test::join({SceneBuilder().floor({2.001f, 0, 0}, 2, cells).build(), wall});
        const double expected = interpolation_error(
            scene, 0, [](const glm::dvec3& p) { return (1 + p.x / std::hypot(p.x, 1)) / 2; });
        constexpr int kSeeds = 4;
        double mean = 0;
        for (int seed = 0; seed < kSeeds; ++seed) {
            BakeOptions options = measured(1, 4096);
            options.seed = static_cast<std::uint64_t>(seed);
            mean += errors_of(scene, options).nodes[0].sky.relative_l2 / kSeeds;
        }
        // About 50 of the points are on the floor: 14 % is one standard deviation for one seed.
        EXPECT_NEAR(mean, expected, 0.14 * expected) << cells;
        EXPECT_GT(expected, 0.01);
    }
}

/// The noise of few rays is the difference from a bake with many rays. The mesh is so fine that interpolation
/// adds no error.
TEST(BakeErrors, IncludeTheNoiseOfRays) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 24).sphere({0, 0.7f, 0}, 0.4f, 24).build();
    const auto transfer = [&](int rays, std::uint64_t seed) {
        BakeOptions options = measured(3, rays);
        options.seed = seed;
        options.repairs.denoise = false;
        return bake(scene, options, {}, MeasureErrors::yes);
    };
    const BakeResult few = transfer(64, 1), many = transfer(1 << 12, 2);
    double noise = 0, norm = 0;
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles) {
            const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
            const double area = static_cast<double>(
                glm::length(glm::cross(vertices.positions[t.y] - vertices.positions[t.x],
                                       vertices.positions[t.z] - vertices.positions[t.x])));
            const std::size_t dimension = few.baked.transfer.dimension();
            for (std::size_t k = 0; k < dimension; ++k) {
                double squares = 0, sum = 0, value = 0;
                for (int i = 0; i < 3; ++i) {
                    const double off = static_cast<double>(few.baked.transfer.vector(t[i])[k] -
                                                           many.baked.transfer.vector(t[i])[k]);
                    squares += off * off;
                    sum += off;
                    value += static_cast<double>(many.baked.transfer.vector(t[i])[k]) / 3;
                }
                noise += area * (squares + sum * sum) / 12; // the mean square over a triangle
                norm += area * value * value;
            }
        }
    const double expected = std::sqrt(noise / norm);
    EXPECT_GT(expected, 0.01);
    EXPECT_NEAR(few.errors->sky.relative_l2, expected, 0.15 * expected);
}

/// Between two plates as fine as that no bounce is missing or counted twice.
TEST(BakeErrors, CountBouncesLikeTheBake) {
    const Scene ceiling = SceneBuilder().quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}).build();
    Scene plates =
        test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 1, 12).build(), ceiling}), glm::vec3(0.8f));
    PunctualLight light;
    light.name = "lamp";
    light.position = {0, 0.5f, 0};
    plates.lights = {light};
    for (const FitMode fit : {FitMode::vertex, FitMode::surface})
        for (const int bounces : {1, 2, 5, kEndlessBounces}) {
            BakeOptions options = measured(2, 256, bounces);
            options.fit = fit;
            const BakeErrors errors = errors_of(plates, options);
            ASSERT_EQ(errors.nodes.size(), 2u);
            EXPECT_LT(errors.nodes[0].sky.relative_l2, 0.03) << bounces;
            EXPECT_LT(errors.nodes[0].lamps.relative_l2, 0.06) << bounces;
        }
}

Scene wall() {
    return SceneBuilder().quad({-1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {-1, 2, 0}).build();
}

/// The back of a sheet in the open shows the lobe of its front: T_lm of odd bands has the wrong sign.
TEST(BakeErrors, IncludeBacksLitFromTheWrongSide) {
    const Scene sheet = test::painted(wall(), glm::vec3(0.5f), true);
    const BakeErrors errors = errors_of(sheet, measured(2, 1024));
    const double t0 = 0.2820948, t1 = 0.4886025 * 2 / 3;
    EXPECT_NEAR(errors.backs.relative_l2, 2 * t1 / std::hypot(t0, t1), 0.02);
    EXPECT_LT(errors.sky.relative_l2, 0.02);
    const Scene one_sided = test::painted(wall(), glm::vec3(0.5f));
    EXPECT_EQ(errors_of(one_sided, measured(2, 64)).backs.relative_l2, 0);
    // The underside of ground is seen by nobody.
    const Scene ground = test::painted(SceneBuilder().floor({0, 0, 0}, 1, 4).build(), glm::vec3(0.5f), true);
    EXPECT_EQ(errors_of(ground, measured(2, 64)).backs.relative_l2, 0);
}

} // namespace
} // namespace prt
