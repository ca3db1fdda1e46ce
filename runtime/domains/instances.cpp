// Factors of instances: conversion to numbers, rotation, and grouping of rotations.

#include "prt/core/instances.h"

#include "prt/core/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Returns the angle between two rotations in degrees.
double degrees_between(const glm::dmat3& a, const glm::dmat3& b) {
    const glm::dmat3 rotation = glm::transpose(a) * b;
    const double cosine = 0.5 * (rotation[0][0] + rotation[1][1] + rotation[2][2] - 1);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool is_upright(const glm::dmat3& rotation) {
    constexpr double kRounding = 1e-6; // rounding error of quaternions in float
    return glm::distance(rotation[1], glm::dvec3(0, 1, 0)) < kRounding;
}

double yaw_of(const glm::dmat3& upright) {
    return std::atan2(upright[2].x, upright[0].x);
}

glm::dmat3 yaw_matrix(double yaw) {
    return {glm::dvec3(std::cos(yaw), 0, -std::sin(yaw)), glm::dvec3(0, 1, 0),
            glm::dvec3(std::sin(yaw), 0, std::cos(yaw))};
}

/// Rotates the first modes, which are SH coefficients of functions of direction; each has `terms` components.
template <class Modes>
void rotate_modes(const ShRotation& rotation, int terms, Modes& modes) {
    const auto count =
        static_cast<std::size_t>(rotation.order()) * static_cast<std::size_t>(rotation.order());
    std::array<float, kPassingModes> coefficients;
    for (int term = 0; term < terms; ++term) {
        for (std::size_t i = 0; i < count; ++i)
            coefficients[i] = modes[i][term];
        const std::span<float> function(coefficients.data(), count);
        rotation.apply(std::span<const float>(function), function);
        for (std::size_t i = 0; i < count; ++i)
            modes[i][term] = coefficients[i];
    }
}

InstanceFactors rotated(InstanceFactors factors, const glm::dmat3& rotation) {
    rotate_modes(ShRotation(kPassingOrder, rotation), 4, factors.passing);
    rotate_modes(ShRotation(kAddedOrder, rotation), 3, factors.added);
    return factors;
}

} // namespace

InstanceFactors open_factors() {
    InstanceFactors factors;
    factors.passing.front() = factors.passing.back() = glm::vec4(0, 0, 0, 1);
    return factors;
}

std::array<float, kInstanceNumbers> numbers_of(const InstanceFactors& factors) {
    std::array<float, kInstanceNumbers> numbers;
    auto to = numbers.begin();
    for (const glm::vec4& row : factors.passing)
        for (int i = 0; i < 4; ++i)
            *to++ = row[i];
    for (const glm::vec3& color : factors.added)
        for (int c = 0; c < 3; ++c)
            *to++ = color[c];
    return numbers;
}

InstanceFactors factors_of(std::span<const float> numbers) {
    InstanceFactors factors;
    auto from = numbers.begin();
    for (glm::vec4& row : factors.passing)
        for (int i = 0; i < 4; ++i)
            row[i] = *from++;
    for (glm::vec3& color : factors.added)
        for (int c = 0; c < 3; ++c)
            color[c] = *from++;
    return factors;
}

CodedFactors coded(std::span<const InstanceFactors> factors) {
    constexpr float kMax = 127;
    const std::array<float, kInstanceNumbers> open = numbers_of(open_factors());
    CodedFactors result;
    for (const InstanceFactors& instance : factors) {
        const std::array<float, kInstanceNumbers> numbers = numbers_of(instance);
        for (std::size_t j = 0; j < kInstanceNumbers; ++j) {
            if (!(std::abs(numbers[j]) <= kMaxInstanceFactor))
                throw Error("a factor of an instance is not finite or not in -60000..60000");
            result.scales[j] = std::max(result.scales[j], std::abs(numbers[j] - open[j]) / kMax);
        }
    }
    for (const InstanceFactors& instance : factors) {
        const std::array<float, kInstanceNumbers> numbers = numbers_of(instance);
        for (std::size_t j = 0; j < kInstanceNumbers; ++j) {
            const float steps = result.scales[j] > 0 ? (numbers[j] - open[j]) / result.scales[j] : 0.0f;
            result.bytes.push_back(static_cast<std::int8_t>(std::lround(std::clamp(steps, -kMax, kMax))));
        }
    }
    return result;
}

std::vector<InstanceFactors> decoded(const CodedFactors& coded) {
    const std::array<float, kInstanceNumbers> open = numbers_of(open_factors());
    std::vector<InstanceFactors> factors;
    for (std::size_t first = 0; first < coded.bytes.size(); first += kInstanceNumbers) {
        std::array<float, kInstanceNumbers> numbers;
        for (std::size_t j = 0; j < kInstanceNumbers; ++j)
            numbers[j] = open[j] + coded.scales[j] * static_cast<float>(coded.bytes[first + j]);
        factors.push_back(factors_of(numbers));
    }
    return factors;
}

CodedLampLight coded(const InstanceLampLight& light) {
    constexpr float kMax = 127;
    CodedLampLight result;
    for (const auto& colors : light.functions)
        for (const glm::vec4& color : colors)
            for (int a = 0; a < 4; ++a) {
                if (!std::isfinite(color[a]))
                    throw Error("the light of a lamp at an instance is not finite");
                result.scale = std::max(result.scale, std::abs(color[a]) / kMax);
            }
    std::size_t j = 0;
    for (const auto& colors : light.functions)
        for (const glm::vec4& color : colors)
            for (int a = 0; a < 4; ++a, ++j)
                if (result.scale > 0)
                    result.bytes[j] = static_cast<std::int8_t>(
                        std::lround(std::clamp(color[a] / result.scale, -kMax, kMax)));
    return result;
}

InstanceLampLight decoded(const CodedLampLight& coded) {
    InstanceLampLight light;
    std::size_t j = 0;
    for (auto& colors : light.functions)
        for (glm::vec4& color : colors)
            for (int a = 0; a < 4; ++a, ++j)
                color[a] = coded.scale * static_cast<float>(coded.bytes[j]);
    return light;
}

InstanceBox bounding_box(std::span<const glm::vec3> positions) {
    glm::vec3 low = positions.front(), high = low;
    for (const glm::vec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const glm::vec3 half = 0.5f * (high - low);
    const float widest = std::max({half.x, half.y, half.z, 1e-12f});
    return {0.5f * (low + high), glm::max(half, glm::vec3(1e-3f * widest))}; // minimum size for flat meshes
}

std::array<glm::vec3, kInstanceModes> mode_factors(const InstanceFactors& factors, const glm::vec3& point) {
    std::array<glm::vec3, kInstanceModes> result;
    for (std::size_t m = 0; m < kPassingModes; ++m)
        result[m] = glm::vec3(glm::dot(factors.passing[m], glm::vec4(point, 1)));
    std::ranges::copy(factors.added, result.begin() + kPassingModes);
    return result;
}

InstanceFactors in_axes_of_mesh(const InstanceFactors& factors, const glm::dmat3& rotation) {
    return rotated(factors, glm::transpose(rotation));
}

InstanceFactors in_axes_of_world(const InstanceFactors& factors, const glm::dmat3& rotation) {
    return rotated(factors, rotation);
}

InstanceRotations instance_rotations(std::span<const glm::dmat3> rotations, int bins, double degrees) {
    InstanceRotations result;
    std::vector<std::uint32_t> of_bin(static_cast<std::size_t>(std::max(bins, 0)), ~0u);
    const auto add = [&](const glm::dmat3& rotation) {
        result.rotations.push_back(rotation);
        return static_cast<std::uint32_t>(result.rotations.size() - 1);
    };
    for (const glm::dmat3& rotation : rotations) {
        std::uint32_t index = ~0u;
        if (bins > 0 && is_upright(rotation)) {
            const double share = yaw_of(rotation) / (2 * std::numbers::pi);
            const auto bin = static_cast<std::size_t>(std::lround((share + 1) * bins)) % of_bin.size();
            if (of_bin[bin] == ~0u)
                of_bin[bin] = add(yaw_matrix(2 * std::numbers::pi * static_cast<double>(bin) / bins));
            index = of_bin[bin];
        } else {
            const auto same = std::ranges::find_if(result.rotations, [&](const glm::dmat3& other) {
                return degrees_between(other, rotation) <= degrees;
            });
            index = same == result.rotations.end()
                        ? add(rotation)
                        : static_cast<std::uint32_t>(same - result.rotations.begin());
        }
        result.max_degrees = std::max(result.max_degrees, degrees_between(result.rotations[index], rotation));
        result.of.push_back(index);
    }
    return result;
}

glm::vec3 exit_radiance(const InstanceFactors& factors, const glm::vec3& point,
                        std::span<const glm::vec3, kInstanceModes> of_modes) {
    const std::array<glm::vec3, kInstanceModes> weights = mode_factors(factors, point);
    glm::vec3 radiance(0);
    for (std::size_t m = 0; m < kInstanceModes; ++m)
        radiance += weights[m] * of_modes[m];
    return radiance;
}

std::array<Lighting, kInstanceModes> rotated_into(const glm::dmat3& rotation,
                                                  std::array<Lighting, kInstanceModes> lightings) {
    const ShRotation into(lightings.front().sky.order, glm::transpose(rotation));
    for (Lighting& lighting : lightings) {
        into.apply(std::span(lighting.sky.coefficients));
        if (lighting.suns)
            into.apply(std::span(lighting.suns->coefficients));
    }
    return lightings;
}

} // namespace prt
