#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// What the clusters may spend on weights, and what a component costs. Prices are in squared error, in which
/// all receivers together weigh 1.
struct Spending {
    int most_components = 8;
    int bits = 0; ///< a receiver's weights together; 0: weights are floats and cost nothing
    /// Bits of each component, the same in all clusters; empty: every cluster divides `bits` as it likes.
    std::vector<int> fixed_bits;
    double row_price = 0;       ///< of one more direction in a cluster
    double operation_price = 0; ///< of one more component for all receivers
};

/// How one cluster spends it.
struct ComponentPlan {
    std::vector<std::uint8_t> bits; ///< [components]; 0 where weights are floats
    double penalty = 0;             ///< per unit of weight: quantisation and the price of operations
    double error = 0;               ///< the same, and the variance along axes left out
};

/// Most bits of a weight.
inline constexpr int kMostBits = 16;

/// The cheapest plan for a cluster of weight `weight` whose variances along its principal axes are
/// `variances`, descending: bits go one by one to where they take away most.
ComponentPlan plan_components(std::span<const double> variances, double weight, const Spending& spending);

/// Of a cluster of weight `weight`, prices included.
inline double cost_of(const ComponentPlan& plan, double weight, const Spending& spending) {
    return weight * plan.error + spending.row_price * static_cast<double>(plan.bits.size());
}

} // namespace prt
