#pragma once

// Bits and components of a cluster.

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Limits and multipliers for weights and components. Multipliers are squared errors; the significance of all
/// receivers together is 1.
struct RateBudget {
    int component_limit = 8;
    int bits = 0; ///< total for a receiver's weights; 0: weights are floats and cost nothing
    /// Bits of each component, identical in all clusters; empty: every cluster distributes `bits` separately.
    std::vector<int> fixed_bits = {};
    double row_multiplier = 0;       ///< multiplier of one more direction in a cluster
    double component_multiplier = 0; ///< multiplier of one more component for all receivers
};

/// Components and bits of one cluster.
struct ComponentPlan {
    std::vector<std::uint8_t> bits; ///< [components]; 0 if weights are floats
    double penalty = 0; ///< per unit of significance: quantisation error and multiplier of components
    double error = 0;   ///< per unit of significance: `penalty` plus the variance along dropped
                        ///< axes
};

/// Maximum bits of a weight.
inline constexpr int kMaxWeightBits = 16;

/// Returns the errors with 0, 1, 2 and more components, without multipliers: the tail of the variances, and
/// rounding of weights. Limited by the bits and `RateBudget::component_limit`.
std::vector<double> errors_by_components(std::span<const double> variances, const RateBudget& rate_budget);

/// Returns the number of components with the minimum cost under the multipliers of `rate_budget`, for such
/// errors.
std::size_t cheapest_components(std::span<const double> errors, double significance,
                                const RateBudget& rate_budget);

/// Returns the cheapest plan for a cluster with `variances` along its principal axes, descending: bits are
/// assigned one by one where they reduce the error most. `significance` is that of all its points.
ComponentPlan plan_components(std::span<const double> variances, double significance,
                              const RateBudget& rate_budget);

/// Returns the cost of a cluster with this significance, including multipliers.
inline double cost_of(const ComponentPlan& plan, double significance, const RateBudget& rate_budget) {
    return significance * plan.error + rate_budget.row_multiplier * static_cast<double>(plan.bits.size());
}

} // namespace prt
