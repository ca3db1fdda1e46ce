// The reference against closed forms, and the baker against the reference.

#include "bake/reference/path_tracer.h"
#include "bake/reference/ray_renderer.h"
#include "prt/bake/bake.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;
using test::SceneBuilder;

Image uniform_environment(float radiance) {
    return {4, 2, std::vector<glm::vec3>(8, glm::vec3(radiance))};
}

/// Returns a sky whose radiance varies everywhere, with a bright spot.
Image uneven_environment() {
    Image image{64, 32, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            image.pixels.emplace_back(0.2f + 0.01f * static_cast<float>(x), 0.5f,
                                      x == 20 && y == 8 ? 90.0f : 0.3f);
    return image;
}

struct Traced {
    Scene scene;
    TraceScene trace;
    DistantLight light;

    Traced(Scene s, DistantLight l) : scene(std::move(s)), trace(scene), light(std::move(l)) {}

    /// Mean over the picture's pixels that show the scene.
    glm::dvec3 mean(const PathTraceOptions& options, int passes) const {
        PathTracer tracer(trace, light, options);
        for (int i = 0; i < passes; ++i)
            tracer.add_pass();
        EXPECT_EQ(tracer.passes(), passes);
        const Image image = tracer.image();
        const std::vector<bool> mask = tracer.surface_mask();
        glm::dvec3 sum(0);
        double count = 0;
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask[i]) {
                sum += glm::dvec3(image.pixels[i]);
                count += 1;
            }
        EXPECT_GT(count, 0);
        return sum / count;
    }
};

PathTraceOptions looking(const glm::vec3& from, const glm::vec3& at) {
    PathTraceOptions options;
    options.camera = {from, at, {0, 1, 0}, 0.5f};
    options.width = options.height = 16;
    options.textured = false;
    options.antialiased = false;
    return options;
}

TEST(DistantLight, SamplesTheStatedDensity) {
    const DistantLight light(uneven_environment());
    // The mean of f / density over samples is the integral of f: here of 1 (4 pi), radiance, and a lobe.
    constexpr int kAlong = 1 << 16, kAcross = 4;
    double sphere = 0, blue = 0, lobe = 0;
    for (int i = 0; i < kAlong * kAcross; ++i) {
        const int column = i % kAlong, row = i / kAlong;
        const glm::vec2 u((static_cast<float>(column) + 0.5f) / kAlong,
                          (static_cast<float>(row) + 0.5f) / kAcross);
        const DistantLight::Sample s = light.sample(u);
        EXPECT_NEAR(light.density(s.direction), s.density, 1e-3f * s.density);
        EXPECT_EQ(light.radiance(s.direction), s.radiance);
        const auto weight = 1.0 / (static_cast<double>(s.density) * kAlong * kAcross);
        sphere += weight;
        blue += weight * static_cast<double>(s.radiance.b);
        lobe += weight * std::max(0.0, static_cast<double>(s.direction.x));
        if (HasFailure())
            return; // one failure suffices, except at borders of texels
    }
    EXPECT_NEAR(sphere, 4 * pi, 0.01 * 4 * pi);
    EXPECT_NEAR(lobe, pi, 0.01 * pi);
    double expected = 0; // exact solid angles
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            expected += static_cast<double>(uneven_environment().at(x, y).b) * 2 * pi / 64 *
                        (std::cos(pi * y / 32) - std::cos(pi * (y + 1) / 32));
    EXPECT_NEAR(blue, expected, 0.002 * expected);
}

TEST(DistantLight, IsSampledFromTheBordersOfTheSquare) {
    Image spot{4, 2, std::vector<glm::vec3>(8, glm::vec3(0))};
    spot.at(1, 0) = {3, 2, 1}; // an eighth of the sphere
    const DistantLight light(spot);
    for (const float u : {0.0f, 0.5f, 1.0f})
        for (const float v : {0.0f, 0.5f, 1.0f}) {
            const DistantLight::Sample s = light.sample({u, v});
            EXPECT_EQ(s.radiance, glm::vec3(3, 2, 1)) << u << " " << v;
            EXPECT_NEAR(s.density, 2 / pi, 1e-6) << u << " " << v;
        }
}

TEST(DistantLight, WithoutAnEnvironmentIsBlack) {
    const DistantLight light({});
    EXPECT_EQ(light.radiance({0, 1, 0}), glm::vec3(0));
    EXPECT_EQ(light.sample({0.3f, 0.4f}).density, 0);
    EXPECT_EQ(light.density({1, 0, 0}), 0);
}

TEST(PathTracer, OpenFloorsHaveTheRadianceOfUniformLight) {
    const Traced traced(SceneBuilder().floor({0, 0, 0}, 2).build(), DistantLight(uniform_environment(0.7f)));
    const glm::dvec3 mean = traced.mean(looking({0, 2, 1}, {0, 0, 0}), 64);
    EXPECT_NEAR(mean.x, 0.7, 0.7 * 0.005);
}

TEST(PathTracer, SunLightIsIrradianceTimesCosineOverPi) {
    const glm::vec3 towards = glm::normalize(glm::vec3(1, 2, 0));
    const Traced traced(SceneBuilder().floor({0, 0, 0}, 2).build(), DistantLight({}, {{towards, {3, 2, 1}}}));
    const glm::dvec3 mean = traced.mean(looking({0, 2, 1}, {0, 0, 0}), 1);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c], (3 - c) * static_cast<double>(towards.y) / pi, 1e-5);
}

// Inside a sphere that is open at the top, R is a geometric series (interreflection_test.cpp).
TEST(PathTracer, BouncesInABowlAreAGeometricSeries) {
    constexpr double kAlbedo = 0.8;
    constexpr int kRows = 40, kOpen = 10;
    const double share = 1 - (1 - std::cos(pi * kOpen / kRows)) / 2;
    const Traced traced(test::painted(SceneBuilder().bowl({0, 0, 0}, 0.5f, kRows, kOpen).build(),
                                      glm::vec3(static_cast<float>(kAlbedo))),
                        DistantLight(uniform_environment(1)));
    PathTraceOptions options = looking({0, 0.3f, 0}, {0.2f, -0.4f, 0});
    for (const int bounces : {0, 1, 3, kEndlessBounces}) {
        double expected = 0, term = 1 - share;
        for (int k = 0; k <= (bounces < 0 ? 200 : bounces); ++k, term *= kAlbedo * share)
            expected += term;
        options.bounces = bounces;
        EXPECT_NEAR(traced.mean(options, 128).x, expected, 0.02 * expected) << bounces;
    }
}

TEST(PathTracer, WhiteSurfacesAreWhiteInUniformLight) {
    const Traced traced(test::painted(SceneBuilder().bowl({0, 0, 0}, 0.5f, 24, 6).build(), glm::vec3(1)),
                        DistantLight(uniform_environment(1)));
    EXPECT_NEAR(traced.mean(looking({0, 0.3f, 0}, {0.2f, -0.4f, 0}), 256).x, 1, 0.02);
}

TEST(PathTracer, BlendedSurfacesTransmitTheirFraction) {
    Scene floor = test::painted(SceneBuilder().floor({0, 0, 0}, 50).build(), glm::vec3(0));
    Scene roof = test::painted(SceneBuilder().floor({0, 5, 0}, 5000).build(), glm::vec3(0), true);
    roof.materials[0].base_color.a = 0.25f;
    roof.materials[0].alpha_mode = AlphaMode::blend;
    const Traced traced(test::join({floor, roof}), DistantLight(uniform_environment(1)));
    EXPECT_NEAR(traced.mean(looking({0, 2, 1}, {0, 0, 0}), 128).x, 0.75, 0.01);
}

TEST(PathTracer, LeavesTransmitTheirFractionOfTheSun) {
    constexpr float kPassed = 0.4f;
    Scene leaf = test::painted(SceneBuilder().floor({0, 0, 0}, 2).build(), glm::vec3(1), true);
    leaf.materials[0].transmission.factor = kPassed;
    // The camera is above, the sun above or below.
    for (const float height : {1.0f, -1.0f}) {
        const glm::vec3 towards = glm::normalize(glm::vec3(1, 2 * height, 0));
        const Traced traced(leaf, DistantLight({}, {{towards, glm::vec3(3)}}));
        const double share = static_cast<double>(height > 0 ? 1 - kPassed : kPassed);
        const double expected = share * 3 * static_cast<double>(std::abs(towards.y)) / pi;
        EXPECT_NEAR(traced.mean(looking({0, 2, 1}, {0, 0, 0}), 1024).x, expected, 0.02 * expected);
    }
}

TEST(PathTracer, AgreesWithTheBakerOnASphereOverAFloor) {
    Scene scene = test::painted(
        SceneBuilder().floor({0, -0.5f, 0}, 2, 60).sphere({0, 0, 0}, 0.5f, 60).build(), {0.8f, 0.5f, 0.3f});
    BakeOptions bake_options;
    bake_options.order = 3;
    bake_options.rays = 512;
    bake_options.bounces = 2;
    bake_options.tracer.backend = Backend::cpu;
    const Transfer transfer = bake(scene, bake_options).baked.transfer;
    // Light of two bands, so that three bands hold all of it.
    Image image{128, 64, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const glm::vec3 d(lat_long_direction(128, 64, x + 0.5, y + 0.5));
            image.pixels.emplace_back(1 + 0.8f * d.y, 1 + 0.5f * d.x, 1.0f);
        }
    const auto radiance = exit_radiance(transfer, project({image}, 3));
    const Traced traced(scene, DistantLight(image));
    PathTraceOptions options = looking({1, 2, 3}, {0, -0.3f, 0});
    options.bounces = 2;
    options.width = options.height = 64;
    Picture picture;
    picture.scene = &scene;
    picture.radiance = radiance;
    picture.textured = false;
    picture.camera = options.camera;
    picture.width = picture.height = 64;
    picture.samples = 1;
    PathTracer tracer(traced.trace, traced.light, options);
    for (int i = 0; i < 256; ++i)
        tracer.add_pass();
    const Image reference = tracer.image(), interpolated = render_rays(picture, traced.trace);
    const std::vector<bool> mask = tracer.surface_mask();
    double squared = 0, norm = 0;
    glm::dvec3 sum(0), reference_sum(0);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (!mask[i])
            continue;
        const glm::dvec3 d = glm::dvec3(interpolated.pixels[i]) - glm::dvec3(reference.pixels[i]);
        squared += glm::dot(d, d);
        norm += glm::dot(glm::dvec3(reference.pixels[i]), glm::dvec3(reference.pixels[i]));
        sum += glm::dvec3(interpolated.pixels[i]);
        reference_sum += glm::dvec3(reference.pixels[i]);
    }
    // Remaining error: 256 paths (about 2 %), and interpolation over the floor's cells at the contact.
    EXPECT_LT(std::sqrt(squared / norm), 0.03);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c] / reference_sum[c], 1, 0.005) << c;
}

} // namespace
} // namespace prt
