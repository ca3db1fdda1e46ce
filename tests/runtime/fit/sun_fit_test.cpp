#include "prt/sun_fit.h"

#include "prt/sh.h"
#include "prt/sky.h"
#include "prt/support/error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

Light sky() {
    return sky_light(kMaxOrder, PreethamSky(3, glm::normalize(glm::dvec3(0.2, 0.9, 0.1))));
}

double angle_between(const glm::vec3& a, const glm::vec3& b) {
    return std::acos(std::min(1.0, static_cast<double>(glm::dot(a, b))));
}

TEST(SunFit, FindsASunInASky) {
    const glm::vec3 towards = glm::normalize(glm::vec3(-0.4f, 0.5f, 0.7f)), irradiance(100, 90, 70);
    const Light all = sum(sky(), directional_light(kMaxOrder, towards, irradiance));
    const SunFit fit = fit_suns(all, 6, 1);
    ASSERT_EQ(fit.lights.size(), 1u);
    EXPECT_LT(angle_between(fit.lights[0].towards, towards), 0.005);
    // The sky has higher bands of its own, which pass for a little sun.
    EXPECT_LT(glm::distance(fit.lights[0].irradiance, irradiance), 0.03f * glm::length(irradiance));
    EXPECT_LT(fit.lights[0].half_angle, 0.06);
}

TEST(SunFit, FindsWhatTheLightsAreWhereTheRestIsSmooth) {
    const FittedLight a{glm::normalize(glm::vec3(1, 1, 0.2f)), {3, 2, 1}, 0.25, 0},
        b{glm::normalize(glm::vec3(-1, 0.3f, -0.5f)), {1, 1, 4}, 0.12, 0};
    const Light smooth = hemisphere_light(kMaxOrder, {0, 1, 0}, {1, 1, 1}, {0.2f, 0.1f, 0});
    const Light all = sum(smooth, sum(as_light(a, kMaxOrder), as_light(b, kMaxOrder)));
    const SunFit fit = fit_suns(all, 4, 2);
    ASSERT_EQ(fit.lights.size(), 2u);
    const FittedLight* expected[] = {&a, &b}; // by luminance
    for (int k = 0; k < 2; ++k) {
        EXPECT_LT(angle_between(fit.lights[static_cast<std::size_t>(k)].towards, expected[k]->towards), 1e-3);
        EXPECT_LT(glm::distance(fit.lights[static_cast<std::size_t>(k)].irradiance, expected[k]->irradiance),
                  1e-2f);
        EXPECT_NEAR(fit.lights[static_cast<std::size_t>(k)].half_angle, expected[k]->half_angle, 5e-3);
    }
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(glm::distance(fit.remainder.coefficients[i], smooth.coefficients[i]), 2e-2f);
    EXPECT_NEAR(fit.lights[0].energy_share + fit.lights[1].energy_share + fit.remainder_share, 1, 1e-9);
}

TEST(SunFit, LightsAndRemainderAddUp) {
    const Light all = sum(sky(), cone_light(kMaxOrder, {0, 1, 1}, 0.3, {5, 5, 5}));
    const SunFit fit = fit_suns(all, 5, 3);
    Light back = fit.remainder;
    for (const FittedLight& light : fit.lights)
        back = sum(back, as_light(light, 5));
    for (std::size_t i = 0; i < 25; ++i)
        EXPECT_LT(glm::distance(back.coefficients[i], all.coefficients[i]),
                  1e-5f * glm::length(all.coefficients[0]));
}

TEST(SunFit, AFittedLightIsACone) {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
    for (const double angle : {0.35, 0.1, 0.01}) {
        const double irradiance = std::numbers::pi * std::sin(angle) * std::sin(angle);
        const Light cone = cone_light(kMaxOrder, axis, angle, glm::vec3(1));
        const Light fitted = as_light({axis, glm::vec3(static_cast<float>(irradiance)), angle, 0}, kMaxOrder);
        for (std::size_t i = 0; i < 100; ++i)
            EXPECT_NEAR(fitted.coefficients[i].r, cone.coefficients[i].r, 1e-5 * irradiance);
    }
}

TEST(SunFit, NothingIsFoundWhereNothingIs) {
    const SunFit fit = fit_suns(constant_light(kMaxOrder, {0, 0, 0}), 3, 2);
    EXPECT_TRUE(fit.lights.empty());
    EXPECT_EQ(fit.remainder_share, 1);
    EXPECT_THROW(fit_suns(constant_light(6, {1, 1, 1}), 3, 1), Error);
    EXPECT_THROW(fit_suns(constant_light(kMaxOrder, {1, 1, 1}), 3, 0), Error);
    EXPECT_THROW(fit_suns(constant_light(kMaxOrder, {1, 1, 1}), 11, 1), Error);
}

} // namespace
} // namespace prt
