// Distributes the bits of a receiver over the components of a cluster: greedily, by the error reduction of
// each bit for a Gaussian (Gersho and Gray 1992, chapter 8; Max 1960).

#include "compress/clusters/component_plan.h"

#include <algorithm>
#include <array>

namespace prt {
namespace {

/// Returns the remaining fraction of a Gaussian variance after the optimal uniform quantiser of b bits (Max
/// 1960, table II, up to 5 bits; beyond, each bit reduces it by another factor of 3.6 to 4).
double left_after(int bits) {
    static constexpr std::array<double, kMaxWeightBits + 1> kLeft = {
        1,       0.3634,  0.1188,  0.03744, 0.01154, 0.003495, 0.001041, 3.04e-4, 8.77e-5,
        2.49e-5, 7.00e-6, 1.95e-6, 5.38e-7, 1.47e-7, 4.0e-8,   1.08e-8,  2.9e-9};
    return kLeft[static_cast<std::size_t>(bits)];
}

double tail(std::span<const double> variances, std::size_t components) {
    double sum = 0;
    for (std::size_t j = components; j < variances.size(); ++j)
        sum += variances[j];
    return sum;
}

/// Returns the reduction of a variance quantised with `bits` bits by one more bit.
double gain_of_bit(double variance, int bits) {
    return bits < kMaxWeightBits ? variance * (left_after(bits) - left_after(bits + 1)) : 0;
}

/// Distributes `bits` over the first `components` axes, one at a time. The plan ends at the last axis with
/// bits.
std::vector<std::uint8_t> divide_bits(std::span<const double> variances, std::size_t components, int bits) {
    std::vector<std::uint8_t> plan(components, 0);
    std::vector<double> gains;
    for (std::size_t j = 0; j < components; ++j)
        gains.push_back(gain_of_bit(variances[j], 0));
    for (; bits > 0; --bits) {
        const auto best = std::max_element(gains.begin(), gains.end());
        if (best == gains.end() || !(*best > 0))
            break;
        const auto j = static_cast<std::size_t>(best - gains.begin());
        *best = gain_of_bit(variances[j], ++plan[j]);
    }
    while (!plan.empty() && plan.back() == 0)
        plan.pop_back();
    return plan;
}

/// Returns the bits of up to `components` axes.
std::vector<std::uint8_t> bits_of(std::span<const double> variances, std::size_t components,
                                  const RateBudget& rate_budget) {
    if (rate_budget.fixed_bits.empty())
        return rate_budget.bits > 0 ? divide_bits(variances, components, rate_budget.bits)
                                    : std::vector<std::uint8_t>(components, 0);
    std::vector<std::uint8_t> bits;
    for (std::size_t j = 0; j < std::min(components, rate_budget.fixed_bits.size()); ++j)
        bits.push_back(static_cast<std::uint8_t>(rate_budget.fixed_bits[j]));
    return bits;
}

/// Returns the error that rounding weights to these bits adds.
double rounding_of(std::span<const double> variances, std::span<const std::uint8_t> bits,
                   const RateBudget& rate_budget) {
    double sum = 0;
    if (rate_budget.bits > 0 || !rate_budget.fixed_bits.empty())
        for (std::size_t j = 0; j < bits.size(); ++j)
            sum += variances[j] * left_after(bits[j]);
    return sum;
}

} // namespace

std::vector<double> errors_by_components(std::span<const double> variances, const RateBudget& rate_budget) {
    const auto rank = static_cast<std::size_t>(
        std::find_if(variances.begin(), variances.end(), [](double v) { return !(v > 0); }) -
        variances.begin());
    const std::size_t most = std::min(rank, static_cast<std::size_t>(rate_budget.component_limit));
    std::vector<double> errors = {tail(variances, 0)};
    for (std::size_t m = 1; m <= most; ++m) {
        const std::vector<std::uint8_t> bits = bits_of(variances, m, rate_budget);
        if (bits.size() < m)
            break; // no bits left for another component
        errors.push_back(tail(variances, m) + rounding_of(variances, bits, rate_budget));
    }
    return errors;
}

std::size_t cheapest_components(std::span<const double> errors, double significance,
                                const RateBudget& rate_budget) {
    const double multiplier =
        rate_budget.component_multiplier + (significance > 0 ? rate_budget.row_multiplier / significance : 0);
    const auto cost = [&](std::size_t m) { return errors[m] + multiplier * static_cast<double>(m); };
    std::size_t best = 0;
    for (std::size_t m = 1; m < errors.size(); ++m)
        if (cost(m) < cost(best))
            best = m;
    return best;
}

ComponentPlan plan_components(std::span<const double> variances, double significance,
                              const RateBudget& rate_budget) {
    const std::vector<double> errors = errors_by_components(variances, rate_budget);
    const std::size_t m = cheapest_components(errors, significance, rate_budget);
    std::vector<std::uint8_t> bits = bits_of(variances, m, rate_budget);
    const double multipliers = rate_budget.component_multiplier * static_cast<double>(m),
                 penalty = multipliers + rounding_of(variances, bits, rate_budget);
    return {std::move(bits), penalty, errors[m] + multipliers};
}

} // namespace prt
