#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// What the clusters may spend on weights, and what a component costs. Prices are in squared error; the
/// significance of all receivers together is 1.
struct Spending {
    int most_components = 8;
    int bits = 0; ///< a receiver's weights together; 0: weights are floats and cost nothing
    /// Bits of each component, the same in all clusters; empty: every cluster divides `bits` as it likes.
    std::vector<int> fixed_bits = {};
    double row_price = 0;       ///< of one more direction in a cluster
    double component_price = 0; ///< of one more component of all receivers
};

/// How one cluster spends it.
struct ComponentPlan {
    std::vector<std::uint8_t> bits; ///< [components]; 0 where weights are floats
    double penalty = 0;             ///< per unit of significance: quantisation and the price of components
    double error = 0;               ///< the same, and the variance along axes left out
};

/// Most bits of a weight.
inline constexpr int kMostBits = 16;

/// The error that 0, 1, 2 and more components leave, without prices: tail of the variances, and rounding of
/// weights. As far as there are bits and `Spending::most_components`.
std::vector<double> errors_by_components(std::span<const double> variances, const Spending& spending);

/// The number of components that is cheapest with the prices of `spending`, of such errors.
std::size_t cheapest_components(std::span<const double> errors, double significance,
                                const Spending& spending);

/// The cheapest plan for a cluster whose variances along its principal axes are `variances`, descending: bits
/// go one by one to where they take away most. `significance` is that of all its points.
ComponentPlan plan_components(std::span<const double> variances, double significance,
                              const Spending& spending);

/// Of a cluster of so much significance, prices included.
inline double cost_of(const ComponentPlan& plan, double significance, const Spending& spending) {
    return significance * plan.error + spending.row_price * static_cast<double>(plan.bits.size());
}

} // namespace prt
