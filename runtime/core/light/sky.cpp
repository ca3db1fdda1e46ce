// Evaluates the clear sky of Preetham, Shirley and Smits (SIGGRAPH 1999), and projects it.
#include "prt/core/light.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/sh/gauss_legendre.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace prt {
namespace {

using std::numbers::pi;

double perez(const std::array<double, 5>& p, double cos_zenith, double gamma) {
    const double cos_gamma = std::cos(gamma);
    return (1 + p[0] * std::exp(p[1] / cos_zenith)) *
           (1 + p[2] * std::exp(p[3] * gamma) + p[4] * cos_gamma * cos_gamma);
}

} // namespace

PreethamSky::PreethamSky(double t, const glm::dvec3& sun) : sun_(sun) {
    if (!(t >= 1.7 && t <= 10))
        throw Error("turbidity must be in 1.7..10, not " + std::to_string(t));
    if (!(std::abs(glm::length(sun) - 1) < 1e-3) || !(sun.y >= 0))
        throw Error("the sun direction of an analytic sky must have length 1 and point above the horizon");
    const double theta_sun = std::acos(std::clamp(sun.y, 0.0, 1.0));
    luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                  -0.0670 * t + 0.3703};
    x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
          -0.0033 * t + 0.0452};
    y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
          -0.0109 * t + 0.0529};
    const double s = theta_sun, s2 = s * s, s3 = s2 * s;
    const double chi = (4.0 / 9 - t / 120) * (pi - 2 * s);
    zenith_luminance_ = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    const double zenith_x = t * t * (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) +
                            t * (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) +
                            (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886);
    const double zenith_y = t * t * (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) +
                            t * (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) +
                            (0.15346 * s3 - 0.26756 * s2 + 0.06670 * s + 0.26688);
    luminance_over_perez_ = zenith_luminance_ / perez(luminance_, 1, theta_sun);
    x_over_perez_ = zenith_x / perez(x_, 1, theta_sun);
    y_over_perez_ = zenith_y / perez(y_, 1, theta_sun);
}

glm::dvec3 PreethamSky::radiance(const glm::dvec3& direction) const {
    if (!(direction.y > 0))
        return glm::dvec3(0);
    const double c = std::max(direction.y, 0.01); // the model has a pole at the horizon
    const double gamma = std::acos(std::clamp(glm::dot(direction, sun_), -1.0, 1.0));
    const double big_y = luminance_over_perez_ * perez(luminance_, c, gamma);
    const double cx = x_over_perez_ * perez(x_, c, gamma), cy = y_over_perez_ * perez(y_, c, gamma);
    const double big_x = big_y * cx / cy, big_z = big_y * (1 - cx - cy) / cy;
    return glm::max(glm::dvec3(3.2406 * big_x - 1.5372 * big_y - 0.4986 * big_z,
                               -0.9689 * big_x + 1.8758 * big_y + 0.0415 * big_z,
                               0.0557 * big_x - 0.2040 * big_y + 1.0570 * big_z),
                    glm::dvec3(0));
}

Light sky_light(int order, const PreethamSky& sky) {
    check_order(order);
    // The glow about the sun has a cusp and needs this many nodes: no coefficient of ten bands has an error
    // above 2.5e-5 of band 0.
    constexpr int kRings = 64, kAzimuths = 128;
    const GaussLegendre rings(kRings);
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    std::vector<glm::dvec3> total(count, glm::dvec3(0));
    std::array<double, kMaxOrder * kMaxOrder> basis{};
    for (std::size_t r = 0; r < kRings; ++r) {
        const double y = 0.5 * (1 + rings.nodes[r]), radius = std::sqrt(1 - y * y);
        const double weight = 0.5 * rings.weights[r] * 2 * pi / kAzimuths;
        for (int a = 0; a < kAzimuths; ++a) {
            const double phi = 2 * pi * (a + 0.5) / kAzimuths;
            const glm::dvec3 w(radius * std::sin(phi), y, radius * std::cos(phi));
            const glm::dvec3 value = weight * sky.radiance(w);
            evaluate_sh(order, w, std::span<double>(basis));
            for (std::size_t i = 0; i < count; ++i)
                total[i] += basis[i] * value;
        }
    }
    Light light{order, std::vector<glm::vec3>(count)};
    for (std::size_t i = 0; i < count; ++i)
        light.coefficients[i] = glm::vec3(total[i]);
    return light;
}

} // namespace prt
