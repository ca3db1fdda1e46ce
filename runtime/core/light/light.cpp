// Computes lights of simple shapes in closed form: zonal coefficients, rotated to the light's direction.
#include "prt/core/light.h"

#include "prt/core/dering.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "runtime/core/light/check_light.h"
#include "runtime/core/light/finite_light.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

namespace prt {

using std::numbers::pi;

namespace {

/// Returns the SH coefficients of an RGB function that is symmetric about `axis`: c_lm = zonal(l) Y_lm(axis),
/// where zonal(l) = 2 pi ∫ f(t) P_l(t) dt (Funk-Hecke; docs/math.md, eq. 11).
Light zonal_light(int order, const glm::vec3& axis, const glm::vec3& scale,
                  const std::function<double(int)>& zonal) {
    check_order(order);
    const double length = glm::length(glm::dvec3(axis));
    if (!(length > 0 && std::isfinite(length)))
        throw Error("the direction of the light has length " + std::to_string(length) +
                    ", but must be finite and not 0");
    Light light{order, std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(order)))};
    std::array<double, kMaxOrder * kMaxOrder> basis{};
    evaluate_sh(order, glm::dvec3(axis) / length, std::span<double>(basis));
    for (int l = 0; l < order; ++l) {
        const double factor = zonal(l);
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            light.coefficients[i] = glm::vec3(glm::dvec3(scale) * (factor * basis[i]));
        }
    }
    return finite_light(std::move(light));
}

Light with_window(const Light& light, double (*window)(int, double)) {
    BandFactors factors{};
    for (int l = 0; l < light.order; ++l)
        factors[static_cast<std::size_t>(l)] = window(l, light.order);
    return with_band_factors(light, factors);
}

} // namespace

void check_light(const Light& light) {
    for (const glm::vec3& coefficient : light.coefficients)
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(coefficient[c]) <= kMaxLight))
                throw Error("the light is too bright: a coefficient is not in -1e18..1e18");
}

Light constant_light(int order, const glm::vec3& radiance) {
    return zonal_light(order, {0, 0, 1}, radiance, [](int l) { return l == 0 ? 4 * pi : 0; });
}

Light directional_light(int order, const glm::vec3& towards, const glm::vec3& irradiance) {
    return zonal_light(order, towards, irradiance, [](int) { return 1.0; });
}

Light cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& radiance) {
    if (!(half_angle >= 0 && half_angle <= pi * (1 + 1e-7))) // pi as a float is larger than pi
        throw Error("the half angle of a cone light must be in 0..pi radians, not " +
                    std::to_string(half_angle));
    std::array<double, kMaxOrder + 1> legendre{}, slope{}; // P_l and P_l' at cos half_angle
    const double t = std::cos(half_angle), sine = std::sin(half_angle),
                 half_sine = std::sin(0.5 * half_angle);
    legendre[0] = 1;
    legendre[1] = t;
    slope[1] = 1;
    for (std::size_t l = 2; l < legendre.size(); ++l) {
        const double ld = static_cast<double>(l);
        legendre[l] = ((2 * ld - 1) * t * legendre[l - 1] - (ld - 1) * legendre[l - 2]) / ld;
        slope[l] = slope[l - 2] + (2 * ld - 1) * legendre[l - 1];
    }
    return zonal_light(order, axis, radiance, [&](int l) {
        return l == 0 ? 4 * pi * half_sine * half_sine
                      : 2 * pi * sine * sine * slope[static_cast<std::size_t>(l)] / (l * (l + 1));
    });
}

Light hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom) {
    return sum(constant_light(order, 0.5f * (top + bottom)),
               zonal_light(order, up, 0.5f * (top - bottom), [](int l) { return l == 1 ? 4 * pi / 3 : 0; }));
}

Light sphere_light(int order, const glm::vec3& center, double radius, const glm::vec3& radiance) {
    const double distance = glm::length(glm::dvec3(center));
    if (!(radius > 0))
        throw Error("the radius of a spherical light must be positive");
    if (!(distance > radius))
        throw Error("the receiver is inside the spherical light: distance " + std::to_string(distance) +
                    ", radius " + std::to_string(radius));
    return cone_light(order, center, std::asin(radius / distance), radiance);
}

Light overcast_sky(int order, const glm::vec3& zenith) {
    // (1 + 2 t) / 3 on the upper hemisphere is a third of the hemispherical cone plus two thirds of the
    // clamped cosine.
    return sum(cone_light(order, {0, 1, 0}, pi / 2, zenith / 3.0f),
               zonal_light(order, {0, 1, 0}, zenith * (2.0f / 3.0f),
                           [](int l) { return pi * clamped_cosine_factor(l); }));
}

Light scaled_to_exit_radiance(const Light& light, const glm::vec3& normal, const glm::vec3& exit_radiance) {
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    clamped_cosine_lobe(light.order, glm::dvec3(normal), std::span<double>(lobe));
    glm::dvec3 now(0);
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        now += lobe[i] * glm::dvec3(light.coefficients[i]);
    Light result = light;
    for (int c = 0; c < 3; ++c) {
        if (!(now[c] > 0))
            throw Error("the light cannot be scaled: it does not reach a receiver with this normal");
        for (glm::vec3& v : result.coefficients)
            v[c] *= static_cast<float>(static_cast<double>(exit_radiance[c]) / now[c]);
    }
    return finite_light(std::move(result));
}

namespace {

void check_same_order(const Light& a, const Light& b) {
    if (a.order != b.order)
        throw Error("the lightings have different orders: " + std::to_string(a.order) + " and " +
                    std::to_string(b.order));
}

} // namespace

Light sum(const Light& a, const Light& b) {
    check_same_order(a, b);
    Light result = a;
    for (std::size_t i = 0; i < result.coefficients.size(); ++i)
        result.coefficients[i] += b.coefficients[i];
    return finite_light(std::move(result));
}

Light blended(const Light& a, const Light& b, float share) {
    check_same_order(a, b);
    Light result = a;
    for (std::size_t i = 0; i < result.coefficients.size(); ++i)
        result.coefficients[i] += share * (b.coefficients[i] - a.coefficients[i]);
    return finite_light(std::move(result));
}

glm::vec3 radiance(const Light& light, const glm::vec3& direction) {
    std::array<float, kMaxOrder * kMaxOrder> basis{};
    evaluate_sh(light.order, direction, std::span<float>(basis));
    glm::vec3 sum(0);
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        sum += basis[i] * light.coefficients[i];
    return sum;
}

Light truncated(const Light& light, int order) {
    if (light.order < order)
        throw Error("the lighting has order " + std::to_string(light.order) + ", but order " +
                    std::to_string(order) + " is needed");
    const auto count = static_cast<std::ptrdiff_t>(coefficient_count(order));
    return finite_light({order, {light.coefficients.begin(), light.coefficients.begin() + count}});
}

Light rotated_about_y(const Light& light, double angle) {
    Light result = light;
    ShRotation::about_y(light.order, angle).apply(result.coefficients);
    return finite_light(std::move(result));
}

Light windowed(const Light& light, Window window) {
    switch (window) {
    case Window::hann:
        return with_window(light, hann_window);
    case Window::lanczos:
        return with_window(light, lanczos_window);
    case Window::automatic:
        return deringed(light);
    case Window::none:
        break;
    }
    return light;
}

} // namespace prt
