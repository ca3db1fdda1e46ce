// Lamps in the reference against closed forms, and the baker's lamps against the reference.

#include "bake/reference/scene_lamps.h"

#include "bake/reference/incident_reference.h"
#include "bake/reference/path_tracer.h"
#include "prt/bake/volume_bake.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;
using test::SceneBuilder;

Scene shining(Scene scene, const std::string& name, const glm::vec3& radiance) {
    for (Material& material : scene.materials) {
        material.name = name;
        material.emission.radiance = radiance;
    }
    return scene;
}

PunctualLight point_light(const std::string& name, const glm::vec3& position, const glm::vec3& intensity) {
    PunctualLight light;
    light.name = name;
    light.position = position;
    light.intensity = intensity;
    return light;
}

std::vector<TransferTerm> lamps_called(std::initializer_list<const char*> names) {
    std::vector<TransferTerm> lamps;
    for (const char* name : names)
        lamps.push_back({.kind = TermKind::lamp, .channels = 3, .name = name});
    return lamps;
}

/// A scene in the dark with one lamp.
struct Night {
    Scene scene;
    TraceScene traced;
    SceneLamps lamps;
    DistantLight dark{Image{}};

    explicit Night(Scene s, const char* lamp = "lamp", const glm::vec3& strength = glm::vec3(1))
        : scene(std::move(s)), traced(scene), lamps(traced, lamps_called({lamp}), std::vector{strength}) {}

    /// Returns the exit radiance for albedo 1 of the surface directly below `eye`.
    glm::vec3 below(const glm::vec3& eye, int passes, int bounces = 0) const {
        PathTraceOptions options;
        options.camera = {eye, eye - glm::vec3(0, 1, 0), {0, 0, 1}, 0.001f};
        options.width = options.height = 1;
        options.bounces = bounces;
        options.textured = false;
        options.antialiased = false;
        PathTracer tracer(traced, dark, options, &lamps);
        for (int i = 0; i < passes; ++i)
            tracer.add_pass(1);
        return tracer.image().pixels[0];
    }

    /// Returns coefficients of order 3 at a position, the mean of both halves.
    std::vector<glm::vec3> incident(const glm::vec3& point, int paths) const {
        const Light black = constant_light(kMaxOrder, glm::vec3(0));
        const ReferenceLight light{DistantLight({}), {}, {}, black, black};
        const auto halves =
            incident_reference(traced, {point}, 3, light, {.paths = paths, .lamps = &lamps, .threads = 1});
        std::vector<glm::vec3> mean;
        for (std::size_t o = 0; o < 9; ++o)
            mean.push_back(0.5f * (halves[0][o] + halves[1][o]));
        return mean;
    }
};

/// E / pi of a floor straight below a point light: I h / (pi d³).
TEST(SceneLamps, APointLightFallsOffByTheSquare) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 5).build();
    scene.lights.push_back(point_light("lamp", {0.5f, 1.5f, 0}, {2, 1, 0.5f}));
    const Night night(scene, "lamp", {1, 3, 1});
    const double d = std::hypot(0.5, 1.5);
    const glm::vec3 lit = night.below({0, 1, 0}, 4);
    EXPECT_NEAR(lit.r, 2 * 1.5 / (pi * d * d * d), 1e-5);
    EXPECT_NEAR(lit.g, 3 * 1.5 / (pi * d * d * d), 1e-5);
    EXPECT_NEAR(lit.b, 0.5 * 1.5 / (pi * d * d * d), 1e-5);
}

TEST(SceneLamps, PointLightsComeFromTheirPosition) {
    Scene scene = test::painted(SceneBuilder().floor({0, -9, 0}, 0.1f).build(), glm::vec3(0));
    scene.lights.push_back(point_light("lamp", {1, 2, -2}, glm::vec3(1)));
    const std::vector<glm::vec3> light = Night(scene).incident({0, 0, 0}, 4);
    std::array<double, 9> basis{};
    evaluate_sh(3, glm::dvec3(1, 2, -2) / 3.0, basis);
    for (std::size_t o = 0; o < 9; ++o)
        EXPECT_NEAR(static_cast<double>(light[o].r), basis[o] / 9, 1e-6) << o;
}

/// Two lights of which either is chosen by chance, one in the shadow.
TEST(SceneLamps, AllLightsContribute) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 5).floor({2, 1, 0}, 0.5f).build();
    scene.lights = {point_light("a", {0, 2, 0}, glm::vec3(1)), point_light("b", {4, 2, 0}, glm::vec3(40)),
                    point_light("c", {0, 1, 0}, glm::vec3(2)), point_light("off", {0, 1, 0}, glm::vec3(5))};
    const TraceScene traced(scene);
    const SceneLamps lamps(traced, lamps_called({"a", "b", "c"}), std::vector(3, glm::vec3(1)));
    const DistantLight dark({});
    PathTraceOptions options;
    options.camera = {{0, 0.5f, 0}, {0, 0, 0}, {0, 0, 1}, 0.001f};
    options.width = options.height = 1;
    options.bounces = 0;
    options.textured = options.antialiased = false;
    PathTracer tracer(traced, dark, options, &lamps);
    for (int i = 0; i < 4096; ++i)
        tracer.add_pass(1);
    EXPECT_NEAR(tracer.image().pixels[0].r, (1.0 / 4 + 2) / pi, 0.01);
}

/// Form factor of a rectangle a x b from below one of its corners, at distance 1 (J. Howell, factor C-13).
double form_factor(double a, double b) {
    const double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
    return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * pi);
}

TEST(SceneLamps, EmissiveSquareLightsAFloorByItsFormFactor) {
    SceneBuilder above;
    above.quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}); // looks down
    const Scene scene = test::join({test::painted(SceneBuilder().floor({0, 0, 0}, 9).build(), glm::vec3(0)),
                                    shining(test::painted(above.build(), glm::vec3(0)), "lamp", {1, 2, 3})});
    const Night night(scene);
    const glm::vec3 lit = night.below({0, 0.5f, 0}, 4096);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(lit[c], (c + 1) * 4 * form_factor(1, 1), 0.004 * (c + 1));
    // A hair before the surface it is half of everything.
    const glm::vec3 near = night.incident({0, 1 - 1e-3f, 0}, 4096)[0];
    EXPECT_NEAR(near.r, std::sqrt(pi), 0.02); // Y_00 · 2 pi
    // Its back is dark.
    EXPECT_NEAR(night.incident({0, 1.5f, 0}, 64)[0].r, 0, 0.05);
}

/// A cone of half angle a: band 0 has Y_00 · 2 pi (1 - cos a), band 1 along the axis K pi sin² a.
TEST(SceneLamps, EmissiveSphereEqualsACone) {
    const Scene scene = shining(test::painted(SceneBuilder().sphere({0, 0, 4}, 1, 48).build(), glm::vec3(0)),
                                "lamp", {1, 1, 2});
    const std::vector<glm::vec3> light = Night(scene).incident({0, 0, 0}, 8192);
    const double sine = 0.25, cosine = std::sqrt(1 - sine * sine);
    const double flat = 2 * pi * (1 - cosine) / std::sqrt(4 * pi),
                 along = std::sqrt(3 / (4 * pi)) * pi * sine * sine;
    EXPECT_NEAR(light[0].r, flat, 0.006 * flat);
    EXPECT_NEAR(light[0].b, 2 * flat, 0.012 * flat);
    EXPECT_NEAR(light[2].r, along, 0.006 * along);
    EXPECT_NEAR(light[1].r, 0, 0.003 * along);
}

/// Walls that shine and reflect: e / (1 - rho), everywhere and from everywhere.
TEST(SceneLamps, EmissiveFurnaceIsTheSumOfItsBounces) {
    SceneBuilder ball;
    ball.bowl({0, 0, 0}, 1, 12, 0);
    const Night night(shining(test::painted(ball.build(), glm::vec3(0.5f)), "lamp", glm::vec3(1)));
    const std::vector<glm::vec3> light = night.incident({0.3f, 0.5f, -0.1f}, 16384);
    EXPECT_NEAR(light[0].r, 2 * std::sqrt(4 * pi), 0.05);
    for (std::size_t o = 1; o < 9; ++o)
        EXPECT_NEAR(light[o].r, 0, 0.05) << o;
    // The visible radiance is e + (albedo 1) · 2 e.
    EXPECT_NEAR(night.below({0, 0, 0}, 8192, kEndlessBounces).r, 1 + 2, 0.03);
}

TEST(SceneLamps, BakerLampsMatchTheReference) {
    SceneBuilder walls, lamp;
    walls.floor({0, 0, 0}, 3, 48);
    for (int i = 0; i < 256; ++i) {
        const int column = i % 16, row = i / 16;
        const glm::vec3 corner(-1 + 0.125f * static_cast<float>(column), 0.125f * static_cast<float>(row),
                               -1),
            right(0.125f, 0, 0), up(0, 0.125f, 0);
        walls.quad(corner, corner + right, corner + right + up, corner + up);
    }
    lamp.quad({-0.4f, 2, -0.4f}, {0.4f, 2, -0.4f}, {0.4f, 2, 0.4f}, {-0.4f, 2, 0.4f});
    Scene scene = test::join({test::painted(walls.build(), {0.7f, 0.5f, 0.3f}),
                              shining(test::painted(lamp.build(), glm::vec3(0)), "panel", {6, 5, 4})});
    scene.lights.push_back(point_light("bulb", {1, 1, 1}, glm::vec3(2)));
    BakeOptions options;
    options.order = 2;
    options.rays = 6 * 1024;
    options.bounces = 3;
    options.lamps.rays = 1024;
    options.tracer.backend = Backend::cpu;
    const std::vector<glm::vec3> positions = {{0, 0.4f, 0}, {0.5f, 1.5f, -0.6f}, {-1.5f, 0.2f, 0.5f}};
    const Transfer baked = bake_positions(scene, positions, 3, options).transfer;
    const std::vector<glm::vec3> lit = exit_radiance(baked, constant_light(2, glm::vec3(0)));
    const TraceScene traced(scene);
    const std::span<const TransferTerm> parts = baked.layout.lamp_terms();
    const SceneLamps lamps(traced, parts, std::vector(parts.size(), glm::vec3(1)));
    const Light black = constant_light(kMaxOrder, glm::vec3(0));
    const auto truth = incident_reference(traced, positions, 3, {DistantLight({}), {}, {}, black, black},
                                          {.paths = 1 << 14, .lamps = &lamps, .threads = 1});
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const glm::dvec3 right(0.5f * (truth[0][i] + truth[1][i])), off = glm::dvec3(lit[i]) - right;
        error += glm::dot(off, off);
        norm += glm::dot(right, right);
    }
    EXPECT_LT(std::sqrt(error / norm), 0.01);
}

TEST(SceneLamps, NeedOneStrengthEach) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    const TraceScene traced(scene);
    EXPECT_THROW(SceneLamps(traced, lamps_called({"a", "b"}), std::vector(1, glm::vec3(1))), Error);
}

} // namespace
} // namespace prt
