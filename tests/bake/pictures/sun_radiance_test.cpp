// Suns shadowed by rays: closed forms of open and half covered discs, and of sheets that let light through.

#include "bake/pipeline/sun_radiance.h"

#include "prt/bake/bake.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

const double kPi = std::numbers::pi;
const glm::vec3 kWhite(3, 2, 1);

/// Returns the radiance of the vertices of one scene.
std::vector<glm::vec3> lit_by(const Scene& scene, const Sun& sun, int rays = 256) {
    const TraceScene traced(scene);
    return sun_radiance(traced, std::span(&sun, 1), {.rays = rays});
}

glm::vec3 from_elevation(double degrees) {
    const double angle = degrees * kPi / 180;
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
}

TEST(SunRadiance, OnAnOpenFloorFallsWithTheCosine) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 1, 2).build();
    for (const double half_angle : {0.0, 0.005, 0.1})
        for (const double elevation : {90.0, 40.0, 7.0}) {
            const Sun sun{from_elevation(elevation), kWhite, half_angle};
            for (const glm::vec3& r : lit_by(floor, sun))
                for (int c = 0; c < 3; ++c) // a spiral of 256 points integrates the cosine to 1e-3
                    EXPECT_NEAR(static_cast<double>(r[c]),
                                static_cast<double>(kWhite[c]) / kPi * std::sin(elevation * kPi / 180),
                                2e-3 * static_cast<double>(kWhite[c]) * std::sin(elevation * kPi / 180) +
                                    1e-6)
                        << half_angle << " " << elevation;
        }
    for (const glm::vec3& r : lit_by(floor, {from_elevation(-5), kWhite, 0.01}))
        EXPECT_EQ(r, glm::vec3(0));
}

/// A small sun on the horizon: its upper half shines on the floor. With x the height over the horizon as a
/// share of the half angle a, the mean of the cosine over the disc is a times (1/pi) ∫ 2 x sqrt(1 - x²) dx =
/// 2 a / (3 pi).
TEST(SunRadiance, SunOnTheHorizonUsesItsUpperHalf) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 1, 2).build();
    const double half_angle = 0.02;
    for (const glm::vec3& r : lit_by(floor, {{1, 0, 0}, glm::vec3(1), half_angle}, 4096))
        EXPECT_NEAR(static_cast<double>(r.x), 2 * half_angle / (3 * kPi) / kPi, 0.01 * half_angle / kPi);
}

/// The edge of a large roof covers half of the sun.
TEST(SunRadiance, HalfTheSunHasHalfTheLight) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 0.01f, 1).build();
    const Scene roof = test::SceneBuilder().quad({0, 1, -5}, {0, 1, 5}, {5, 1, 5}, {5, 1, -5}).build();
    const Scene scene = test::join({floor, roof});
    const Sun sun{{0, 1, 0}, glm::vec3(1), 0.1};
    const std::vector<glm::vec3> lit = lit_by(scene, sun, 4096);
    double mean = 0; // corners are 0.01 on either side of the middle
    for (std::size_t p = 0; p < floor.receivers(); ++p)
        mean += static_cast<double>(lit[p].x) / static_cast<double>(floor.receivers());
    EXPECT_NEAR(mean, 0.5 / kPi, 0.01 / kPi);
}

/// A blended pane over all of the floor keeps back its alpha.
TEST(SunRadiance, IsDimmedByBlendedSurfaces) {
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 0.1f, 1).build();
    Scene pane = test::SceneBuilder().floor({0, 1, 0}, 4, 1).build();
    pane.materials[0].alpha_mode = AlphaMode::blend;
    pane.materials[0].base_color.a = 0.25f;
    const std::vector<glm::vec3> lit = lit_by(test::join({floor, pane}), {{0, 1, 0}, glm::vec3(1), 0.01});
    for (std::size_t p = 0; p < floor.receivers(); ++p)
        EXPECT_NEAR(static_cast<double>(lit[p].x), 0.75 / kPi, 1e-3);
}

/// A leaf lit from below shows the transmitted light, divided by its base color (docs/math.md, eq. 38).
TEST(SunRadiance, ComesThroughALeaf) {
    Scene leaf = test::painted(test::SceneBuilder().floor({0, 0, 0}, 1, 1).build(), glm::vec3(0.5f), true);
    leaf.materials[0].transmission.factor = 0.4f;
    for (const glm::vec3& r : lit_by(leaf, {{0, -1, 0}, glm::vec3(1), 0.01}))
        EXPECT_NEAR(static_cast<double>(r.x), 0.4 / 0.5 / kPi, 2e-3);
    for (const glm::vec3& r : lit_by(leaf, {{0, 1, 0}, glm::vec3(1), 0.01}))
        EXPECT_NEAR(static_cast<double>(r.x), 0.6 / kPi, 2e-3);
}

/// Transfer and rays agree for a sun wide enough for order 10.
TEST(SunRadiance, WideSunMatchesTransfer) {
    const Scene scene = test::SceneBuilder().floor({0, 0, 0}, 2, 6).sphere({0, 0.8f, 0}, 0.5f, 10).build();
    const Sun sun{glm::normalize(glm::vec3(0.4f, 1, 0.2f)), glm::vec3(1), 0.6};
    BakeOptions options;
    options.order = 10;
    options.rays = 2048;
    options.tracer.backend = Backend::cpu;
    const auto by_transfer = exit_radiance(bake(scene, options).baked.transfer, as_light(sun, 10)),
               by_rays = lit_by(scene, sun, 1024);
    const std::vector<float> areas = receiver_areas(scene);
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < by_rays.size(); ++p) {
        error +=
            static_cast<double>(areas[p]) * std::pow(static_cast<double>(by_rays[p].x - by_transfer[p].x), 2);
        norm += static_cast<double>(areas[p]) * std::pow(static_cast<double>(by_rays[p].x), 2);
    }
    // Order 10 has an error of 2 % for a disc of 34 degrees in shadow.
    EXPECT_LT(std::sqrt(error / norm), 0.03);
}

} // namespace
} // namespace prt
