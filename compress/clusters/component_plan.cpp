// Divides the bits of a receiver among the components of a cluster: greedily, by what each bit takes away of
// a Gaussian (Gersho and Gray 1992, chapter 8; Max 1960).

#include "clusters/component_plan.h"

#include <algorithm>
#include <array>

namespace prt {
namespace {

/// What is left of a Gaussian variance after the best uniform quantiser of b bits (Max 1960, table II, to 5
/// bits; beyond, each bit takes another 3.6 to 4 times).
double left_after(int bits) {
    static constexpr std::array<double, kMostBits + 1> kLeft = {
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

/// Gives `bits` to the first `components` axes, one at a time. Axes that get none end the plan.
std::vector<std::uint8_t> divide_bits(std::span<const double> variances, std::size_t components, int bits) {
    std::vector<std::uint8_t> plan(components, 0);
    for (; bits > 0; --bits) {
        std::size_t best = components;
        double most = 0;
        for (std::size_t j = 0; j < components; ++j) {
            if (plan[j] == kMostBits)
                continue;
            const double gain = variances[j] * (left_after(plan[j]) - left_after(plan[j] + 1));
            if (gain > most) {
                most = gain;
                best = j;
            }
        }
        if (best == components)
            break;
        ++plan[best];
    }
    while (!plan.empty() && plan.back() == 0)
        plan.pop_back();
    return plan;
}

} // namespace

ComponentPlan plan_components(std::span<const double> variances, double significance,
                              const Spending& spending) {
    const auto rank = static_cast<std::size_t>(
        std::find_if(variances.begin(), variances.end(), [](double v) { return !(v > 0); }) -
        variances.begin());
    const std::size_t most = std::min(rank, static_cast<std::size_t>(spending.most_components));
    ComponentPlan best{{}, 0, tail(variances, 0)};
    double best_cost = best.error;
    const double row_price = significance > 0 ? spending.row_price / significance : 0;
    for (std::size_t m = 1; m <= most; ++m) {
        std::vector<std::uint8_t> bits;
        if (!spending.fixed_bits.empty())
            for (std::size_t j = 0; j < std::min(m, spending.fixed_bits.size()); ++j)
                bits.push_back(static_cast<std::uint8_t>(spending.fixed_bits[j]));
        else if (spending.bits > 0)
            bits = divide_bits(variances, m, spending.bits);
        else
            bits.assign(m, 0);
        if (bits.size() < m)
            break; // no bits left for another component
        double penalty = spending.component_price * static_cast<double>(m);
        if (spending.bits > 0 || !spending.fixed_bits.empty())
            for (std::size_t j = 0; j < m; ++j)
                penalty += variances[j] * left_after(bits[j]);
        const double error = tail(variances, m) + penalty;
        const double cost = error + row_price * static_cast<double>(m);
        if (cost < best_cost) {
            best_cost = cost;
            best = {std::move(bits), penalty, error};
        }
    }
    return best;
}

} // namespace prt
