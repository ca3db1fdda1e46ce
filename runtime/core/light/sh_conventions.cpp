// Converts lighting between prtkit, three.js, glTF and D3DX (docs/conventions.md).
#include "prt/core/light.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/light/finite_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace prt {
namespace {

template <class Value>
void flip(int order, std::span<Value> coefficients) {
    for (int l = 1; l < order; ++l)
        for (int m = 1; m <= l; m += 2) {
            coefficients[static_cast<std::size_t>(sh_index(l, m))] *= -1;
            coefficients[static_cast<std::size_t>(sh_index(l, -m))] *= -1;
        }
}

constexpr int kBands = 3;

/// Returns the factor of band l from radiance to irradiance.
float irradiance_factor(int l) {
    return static_cast<float>(std::numbers::pi * clamped_cosine_factor(l));
}

} // namespace

void flip_condon_shortley(int order, std::span<float> coefficients) {
    flip(order, coefficients);
}

void flip_condon_shortley(int order, std::span<double> coefficients) {
    flip(order, coefficients);
}

void flip_condon_shortley(int order, std::span<glm::vec3> coefficients) {
    flip(order, coefficients);
}

std::array<glm::vec3, 9> to_three_js(const Light& light) {
    Light three = truncated(light, kBands);
    flip_condon_shortley(kBands, std::span<glm::vec3>(three.coefficients));
    std::array<glm::vec3, 9> result;
    std::copy(three.coefficients.begin(), three.coefficients.end(), result.begin());
    return result;
}

Light from_three_js(const std::array<glm::vec3, 9>& coefficients) {
    Light light{kBands, {coefficients.begin(), coefficients.end()}};
    flip_condon_shortley(kBands, std::span<glm::vec3>(light.coefficients));
    return finite_light(std::move(light));
}

std::array<glm::vec3, 9> to_gltf_irradiance(const Light& light) {
    std::array<glm::vec3, 9> result = to_three_js(light);
    for (int l = 0; l < kBands; ++l)
        for (int m = -l; m <= l; ++m)
            result[static_cast<std::size_t>(sh_index(l, m))] *= irradiance_factor(l);
    check_finite(result);
    return result;
}

Light from_gltf_irradiance(const std::array<glm::vec3, 9>& coefficients) {
    Light light = from_three_js(coefficients);
    for (int l = 0; l < kBands; ++l)
        for (int m = -l; m <= l; ++m)
            light.coefficients[static_cast<std::size_t>(sh_index(l, m))] /= irradiance_factor(l);
    return finite_light(std::move(light));
}

Light d3dx_directional_light(int order, const glm::vec3& towards, const glm::vec3& intensity) {
    Light light =
        scaled_to_exit_radiance(directional_light(order, towards, glm::vec3(1)), towards, glm::vec3(1));
    for (glm::vec3& c : light.coefficients)
        c *= intensity;
    return finite_light(std::move(light));
}

Light d3dx_cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& intensity) {
    if (!(half_angle > 0))
        throw Error("the half angle of a D3DX cone light must be greater than 0");
    const double sine = std::sin(std::min(half_angle, 0.5 * std::numbers::pi));
    return cone_light(order, axis, half_angle, intensity / static_cast<float>(sine * sine));
}

Light d3dx_hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom) {
    return hemisphere_light(order, up, 1.5f * top, 1.5f * bottom);
}

} // namespace prt
