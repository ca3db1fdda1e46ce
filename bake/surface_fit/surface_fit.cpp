// Fits light to samples within the range of the samples.

#include "bake/surface_fit/surface_fit.h"

namespace prt {
namespace {

/// Adds `few` [count][few_stride] to each channel of `many` [count][many_stride].
void add_to_channels(std::span<const float> few, std::size_t few_stride, std::span<float> many,
                     std::size_t many_stride) {
    for (std::size_t i = 0; i * many_stride < many.size(); ++i)
        for (std::size_t c = 0; c < many_stride; ++c)
            many[i * many_stride + c] += few[i * few_stride + c % few_stride];
}

} // namespace

SharpFit::Values SharpFit::values_of(const SampledLight& light, const FitSolver& solver) const {
    Values values{light.sums, light.sharp};
    fit_.smooth(std::span(values.smooth), light.stride);
    if (light.sharp.empty()) {
        values.sharp = light.sums;
        solver.solve(values.sharp, light.stride, threads_);
    }
    return values;
}

/// Mixes smooth and sharp values; the result is in `values.sharp`.
void SharpFit::mix(const TestValues& tests, std::span<const float> shares, Values& values) const {
    const std::size_t unknowns = fit_.equations.unknowns,
                      stride = unknowns > 0 ? values.sharp.size() / unknowns : 0;
    for (std::size_t u = 0; u < unknowns; ++u)
        for (std::size_t c = 0; c < stride; ++c) {
            const std::uint32_t group = tests.group_of_column(c);
            const float share = group == kNoReceiver ? 0 : shares[u * tests.groups() + group];
            float& v = values.sharp[u * stride + c];
            v = values.smooth[u * stride + c] + share * (v - values.smooth[u * stride + c]);
        }
}

SharpLight SharpFit::solve(const TestValues& of_direct, const SampledLight& direct, const TestValues* of_rest,
                           const SampledLight* rest) const {
    const FitEquations& equations = fit_.equations;
    std::vector<float> shares(equations.unknowns * of_direct.groups(), 1.0f);
    Values first = values_of(direct, of_direct_);
    limit_shares(of_direct, value_ranges(equations, direct.values, of_direct.count()), first.smooth,
                 first.sharp, shares);
    SharpLight result;
    if (rest) {
        Values second = values_of(*rest, of_rest_);
        limit_shares(*of_rest, value_ranges(equations, rest->values, of_rest->count()), second.smooth,
                     second.sharp, shares);
        std::vector<float> values = rest->values;
        add_to_channels(direct.values, of_direct.count(), values, of_rest->count());
        Values both = second;
        add_to_channels(first.smooth, direct.stride, both.smooth, rest->stride);
        add_to_channels(first.sharp, direct.stride, both.sharp, rest->stride);
        limit_shares(*of_rest, value_ranges(equations, values, of_rest->count()), both.smooth, both.sharp,
                     shares);
        mix(*of_rest, shares, second);
        result.rest = std::move(second.sharp);
    }
    mix(of_direct, shares, first);
    result.direct = std::move(first.sharp);
    return result;
}

} // namespace prt
