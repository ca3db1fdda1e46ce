#pragma once

// Bits and components of a cluster.

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Limits and prices for weights and components. Prices are squared errors; the significance of all receivers
/// together is 1.
struct Spending {
    int component_limit = 8;
    int bits = 0; ///< total for a receiver's weights; 0: weights are floats and cost nothing
    /// Bits of each component, identical in all clusters; empty: every cluster distributes `bits` separately.
    std::vector<int> fixed_bits = {};
    double row_price = 0;       ///< price of one more direction in a cluster
    double component_price = 0; ///< price of one more component for all receivers
};

/// Components and bits of one cluster.
struct ComponentPlan {
    std::vector<std::uint8_t> bits; ///< [components]; 0 if weights are floats
    double penalty = 0;             ///< per unit of significance: quantisation error and price of components
    double error = 0;               ///< per unit of significance: `penalty` plus the variance along dropped
                                    ///< axes
};

/// Maximum bits of a weight.
inline constexpr int kMaxWeightBits = 16;

/// Returns the errors with 0, 1, 2 and more components, without prices: the tail of the variances, and
/// rounding of weights. Limited by the bits and `Spending::component_limit`.
std::vector<double> errors_by_components(std::span<const double> variances, const Spending& spending);

/// Returns the number of components with the minimum cost under the prices of `spending`, for such errors.
std::size_t cheapest_components(std::span<const double> errors, double significance,
                                const Spending& spending);

/// Returns the cheapest plan for a cluster with `variances` along its principal axes, descending: bits are
/// assigned one by one where they reduce the error most. `significance` is that of all its points.
ComponentPlan plan_components(std::span<const double> variances, double significance,
                              const Spending& spending);

/// Returns the cost of a cluster with this significance, including prices.
inline double cost_of(const ComponentPlan& plan, double significance, const Spending& spending) {
    return significance * plan.error + spending.row_price * static_cast<double>(plan.bits.size());
}

} // namespace prt
