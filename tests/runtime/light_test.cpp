#include "prt/light.h"

#include "prt/error.h"
#include "prt/sh.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Largest coefficient error of `light` against integrals of `radiance`, red channel.
double largest_error(const Light& light, int cells,
                     const std::function<double(const glm::dvec3&)>& radiance) {
    double largest = 0;
    for (std::size_t i = 0; i < light.coefficients.size(); ++i) {
        const double integral = test::integrate_sphere(cells, [&](const glm::dvec3& w) {
            std::array<double, kMaxOrder * kMaxOrder> y{};
            const double l = radiance(w);
            if (l != 0)
                evaluate_sh(light.order, w, std::span<double>(y));
            return l * y[i];
        });
        largest = std::max(largest, std::abs(integral - static_cast<double>(light.coefficients[i].r)));
    }
    return largest;
}

TEST(Light, ConstantLightLightsAnOpenReceiverWithItsRadiance) {
    const Light light = constant_light(5, glm::vec3(1, 2, 3));
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(5, {0, 0, 1}, lobe);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += lobe[i] * glm::dvec3(light.coefficients[i]);
    EXPECT_NEAR(sum.r, 1, 1e-6);
    EXPECT_NEAR(sum.g, 2, 1e-6);
    EXPECT_NEAR(sum.b, 3, 1e-6);
}

TEST(Light, ConeAgreesWithQuadrature) {
    const glm::vec3 axis = glm::normalize(glm::vec3(0.2f, 0.8f, -0.4f));
    const Light light = cone_light(5, axis, 0.7, glm::vec3(2));
    const double error = largest_error(light, 600, [&](const glm::dvec3& w) {
        return glm::dot(w, glm::dvec3(axis)) > std::cos(0.7) ? 2.0 : 0.0;
    });
    EXPECT_LT(error, 2e-3); // a cell is 2e-5 sr; some thousand lie on the rim
}

TEST(Light, ConeOfTheWholeSphereIsConstant) {
    const Light cone = cone_light(10, {0, 1, 0}, pi, glm::vec3(1)),
                constant = constant_light(10, glm::vec3(1));
    for (std::size_t i = 0; i < cone.coefficients.size(); ++i)
        EXPECT_NEAR(cone.coefficients[i].r, constant.coefficients[i].r, 1e-6f);
}

TEST(Light, OvercastSkyAgreesWithQuadrature) {
    const Light sky = overcast_sky(4, glm::vec3(3));
    const double error =
        largest_error(sky, 600, [](const glm::dvec3& w) { return w.y > 0 ? 1 + 2 * w.y : 0.0; });
    EXPECT_LT(error, 2e-3);
}

TEST(Light, DirectionalLightGivesItsIrradianceToAFacingReceiver) {
    // Cut at ten bands the clamped cosine at its peak is the sum of A_l (2l+1) / (4 pi), with
    // A_l = pi (1, 2/3, 1/4, 0, -1/24, 0, 1/64, 0, -1/128): 1.4 % below the 1 of all bands.
    const double peak = (1 + 2 + 5 / 4.0 - 9 / 24.0 + 13 / 64.0 - 17 / 128.0) / 4;
    EXPECT_NEAR(peak, 1, 0.014);
    const glm::vec3 towards = glm::normalize(glm::vec3(1, 2, -1));
    const Light light = directional_light(10, towards, glm::vec3(5));
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(10, glm::dvec3(towards), lobe);
    double sum = 0;
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += lobe[i] * static_cast<double>(light.coefficients[i].r);
    EXPECT_NEAR(sum, 5 * peak / pi, 1e-6);
}

TEST(Light, AQuarterTurnAboutYTakesLightFromZToX) {
    const Light from_z = cone_light(6, {0, 0, 1}, 0.3, glm::vec3(1)),
                from_x = cone_light(6, {1, 0, 0}, 0.3, glm::vec3(1));
    const Light turned = rotated_about_y(from_z, pi / 2);
    for (std::size_t i = 0; i < turned.coefficients.size(); ++i)
        EXPECT_NEAR(turned.coefficients[i].r, from_x.coefficients[i].r, 1e-6f);
}

TEST(Light, WindowsLeaveTheMeanAndDampTheRest) {
    const Light light = directional_light(6, {0, 1, 0}, glm::vec3(1));
    for (const Window window : {Window::hann, Window::lanczos}) {
        const Light damped = windowed(light, window);
        EXPECT_FLOAT_EQ(damped.coefficients[0].r, light.coefficients[0].r);
        EXPECT_LT(std::abs(damped.coefficients[sh_index(5, -5)].r),
                  std::abs(light.coefficients[sh_index(5, -5)].r));
    }
}

float least_radiance(const Light& light) {
    float least = std::numeric_limits<float>::infinity();
    for (const auto& point : test::sphere_quadrature(40))
        least = std::min(least, radiance(light, glm::vec3(point.direction)).r);
    return least;
}

TEST(Light, AutomaticWindowMakesASunNonNegativeAndLeavesASkyAlone) {
    const glm::vec3 towards = glm::normalize(glm::vec3(1, 1, 1));
    const Light sun = directional_light(6, towards, glm::vec3(1));
    EXPECT_LT(least_radiance(sun), -0.1f * radiance(sun, towards).r);
    const Light quiet = windowed(sun, Window::automatic);
    EXPECT_GT(least_radiance(quiet), -1e-3f * radiance(quiet, towards).r);
    EXPECT_GT(quiet.coefficients[2].r, 0.5f * sun.coefficients[2].r); // not more than is needed

    const Light sky = constant_light(6, glm::vec3(1));
    EXPECT_EQ(windowed(sky, Window::automatic).coefficients, sky.coefficients);
}

TEST(Light, MoreBandsThanThereAreCannotBeHad) {
    EXPECT_THROW(truncated(constant_light(3, glm::vec3(1)), 4), Error);
    EXPECT_EQ(truncated(constant_light(4, glm::vec3(1)), 3).coefficients.size(), 9u);
}

} // namespace
} // namespace prt
