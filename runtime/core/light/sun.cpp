// Computes suns as SH coefficients in closed form.
#include "prt/core/light.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace prt {
namespace {

/// Returns the factors of a disc of irradiance 1 relative to Y_lm of its axis: eq. 14, which is eq. 12
/// without the differences that cancel for narrow cones.
std::array<double, kMaxOrder> disc_factors(double half_angle) {
    const double t = std::cos(half_angle);
    std::array<double, kMaxOrder> factors{};
    factors[0] = 2 / (1 + t);
    double legendre_before = 1, legendre = t, slope_before = 0, slope = 1;
    for (int l = 1; l < kMaxOrder; ++l) {
        factors[static_cast<std::size_t>(l)] = 2 * slope / (l * (l + 1.0));
        const double next = ((2 * l + 1) * t * legendre - l * legendre_before) / (l + 1);
        const double next_slope = slope_before + (2 * l + 1) * legendre;
        legendre_before = legendre;
        legendre = next;
        slope_before = slope;
        slope = next_slope;
    }
    return factors;
}

} // namespace

Light as_light(const Sun& sun, int order) {
    if (!(sun.half_angle >= 0 && sun.half_angle <= 0.5 * std::numbers::pi))
        throw Error("the half angle of a sun must be in 0..pi/2 radians, not " +
                    std::to_string(sun.half_angle));
    Light result = directional_light(order, sun.towards, sun.irradiance);
    const auto factors = disc_factors(sun.half_angle);
    for (int l = 0; l < order; ++l)
        for (int m = -l; m <= l; ++m)
            result.coefficients[static_cast<std::size_t>(sh_index(l, m))] *=
                static_cast<float>(factors[static_cast<std::size_t>(l)]);
    return result;
}

Light as_light(std::span<const Sun> suns, int order) {
    Light together = constant_light(order, glm::vec3(0));
    for (const Sun& sun : suns)
        together = sum(together, as_light(sun, order));
    return together;
}

} // namespace prt
