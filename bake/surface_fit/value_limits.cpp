// Mixes sharp values with smooth ones until they are within the range of the samples.

#include "bake/surface_fit/value_limits.h"

#include "prt/core/sh.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace prt {
namespace {

/// Tolerance of the range relative to the largest value: rounding of sums must not affect a fit where light
/// is uniform.
constexpr float kSlack = 2e-4f;
/// Share of the range by which values that are not exact may exceed it: a half preserves almost all of the
/// fit's gain, measured on four scenes.
constexpr float kOvershoot = 0.5f;
constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// Coefficients of a light that is symmetric about `axis`, with Legendre factors f_l.
std::vector<float> zonal_light(int bands, const glm::dvec3& axis, const std::array<double, 3>& factors) {
    std::vector<double> basis(static_cast<std::size_t>(coefficient_count(bands)));
    evaluate_sh(bands, axis, basis);
    std::vector<float> light;
    for (int l = 0; l < bands; ++l)
        for (int m = -l; m <= l; ++m)
            light.push_back(
                static_cast<float>(4 * std::numbers::pi / (2 * l + 1) * factors[static_cast<std::size_t>(l)] *
                                   basis[static_cast<std::size_t>(l * (l + 1) + m)]));
    return light;
}

/// Test lights: uniform light of radiance 1; then, along both directions of each axis, (1 + cos)² / 4, or (1
/// + cos) / 2 if there are only two bands.
std::vector<std::vector<float>> test_lights(int order) {
    const int bands = std::min(order, 3);
    std::vector<std::vector<float>> lights{zonal_light(1, {0, 0, 1}, {1, 0, 0})};
    const std::array<double, 3> factors =
        bands < 3 ? std::array<double, 3>{0.5, 0.5, 0} : std::array<double, 3>{1.0 / 3, 0.5, 1.0 / 6};
    for (int axis = 0; axis < 3 && bands > 1; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 direction(0);
            direction[axis] = sign;
            lights.push_back(zonal_light(bands, direction, factors));
        }
    return lights;
}

} // namespace

TestValues TestValues::of_sky(int order, int channels) {
    TestValues result;
    const auto size = static_cast<std::size_t>(coefficient_count(order));
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
        for (const std::vector<float>& light : test_lights(order))
            result.tests_.push_back({c * size, light, 0, false, light.size() == 1 ? 1.0f : kUnbounded});
    result.group_of_column_.assign(static_cast<std::size_t>(channels) * size, 0);
    return result;
}

TestValues TestValues::of_lamps(std::size_t lamps, int channels, std::size_t stride) {
    TestValues result;
    result.groups_ = lamps;
    result.group_of_column_.assign(static_cast<std::size_t>(channels) * stride, kNoReceiver);
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
        for (std::size_t k = 0; k < lamps; ++k) {
            result.tests_.push_back({c * stride + k, {1}, k, true, kUnbounded});
            result.group_of_column_[c * stride + k] = static_cast<std::uint32_t>(k);
        }
    return result;
}

void TestValues::evaluate(std::span<const float> vector, std::span<float> values) const {
    for (std::size_t t = 0; t < tests_.size(); ++t) {
        const Test& test = tests_[t];
        float sum = 0;
        for (std::size_t i = 0; i < test.weights.size(); ++i)
            sum += test.weights[i] * vector[test.first + i];
        values[t] = sum;
    }
}

ValueRanges value_ranges(const FitEquations& equations, std::span<const float> values, std::size_t tests) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ValueRanges ranges{std::vector<float>(equations.unknowns * tests, kInfinity),
                       std::vector<float>(equations.unknowns * tests, -kInfinity)};
    for (std::size_t s = 0; s < equations.rows.size(); ++s)
        for (const std::uint32_t u : equations.rows[s].unknowns)
            for (std::size_t t = 0; u != kNoReceiver && t < tests; ++t) {
                float &low = ranges.low[u * tests + t], &high = ranges.high[u * tests + t];
                low = std::min(low, values[s * tests + t]);
                high = std::max(high, values[s * tests + t]);
            }
    return ranges;
}

void limit_shares(const TestValues& tests, const ValueRanges& ranges, std::span<const float> smooth,
                  std::span<const float> sharp, std::span<float> shares) {
    const std::size_t count = tests.count(), groups = tests.groups(), unknowns = shares.size() / groups;
    const std::size_t stride = unknowns > 0 ? smooth.size() / unknowns : 0;
    std::vector<float> from(count), to(count);
    for (std::size_t u = 0; u < unknowns; ++u) {
        tests.evaluate(smooth.subspan(u * stride, stride), from);
        tests.evaluate(sharp.subspan(u * stride, stride), to);
        for (std::size_t t = 0; t < count; ++t) {
            const float low = ranges.low[u * count + t], high = ranges.high[u * count + t];
            float& share = shares[u * groups + tests.group_of_test(t)];
            const float slack = kSlack * std::max(std::abs(low), std::abs(high)),
                        more = slack + (tests.exact(t) ? 0 : kOvershoot * (high - low));
            const float least = std::max(low - more, std::min(low, 0.0f)),
                        most = std::min(high + more, std::max(high + slack, tests.bound(t)));
            if (low > high)
                share = 0; // no sample
            else if (to[t] > most)
                share = std::min(share, std::max(0.0f, (most - from[t]) / (to[t] - from[t])));
            else if (to[t] < least)
                share = std::min(share, std::max(0.0f, (from[t] - least) / (from[t] - to[t])));
        }
    }
}

} // namespace prt
