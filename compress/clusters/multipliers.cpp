// Finds the multipliers (Lagrange multipliers of rate and distortion) for which bases and components meet
// their limits (docs/math.md, section 4, "Different sizes").

#include "compress/clusters/multipliers.h"

#include "compress/tuning/tuning.h"

#include <cmath>

namespace prt {

/// One more bit for the weights of each of V receivers removes kGainPerBit/m of the error (m components share
/// it), so that one bit is worth kGainPerBit/m/V of it; a row takes kBitsPerRow.
double row_multiplier(const ClusterState& state) {
    double rows = 0;
    for (const ClusterFit& fit : state.fits)
        rows += static_cast<double>(fit.plan.bits.size());
    const double mean = std::max(1.0, rows / static_cast<double>(state.fits.size()));
    return tuning::kBitsPerRow * tuning::kGainPerBit / mean * state.cost /
           static_cast<double>(state.clusters.size());
}

double component_multiplier(const ClusterState& state, RateBudget rate_budget, double most) {
    std::vector<double> members(state.fits.size(), 0);
    for (const std::uint32_t k : state.clusters)
        members[k] += 1;
    std::vector<std::vector<double>> errors; // the multiplier affects the choice among these errors, not the
                                             // errors
    for (const ClusterFit& fit : state.fits)
        errors.push_back(errors_by_components(fit.variances, rate_budget));
    const auto mean = [&](double multiplier) {
        rate_budget.component_multiplier = multiplier;
        double sum = 0;
        for (std::size_t k = 0; k < state.fits.size(); ++k)
            sum += members[k] * static_cast<double>(
                                    cheapest_components(errors[k], state.fits[k].significance, rate_budget));
        return sum / static_cast<double>(state.clusters.size());
    };
    double low = 0, high = 1;
    if (mean(low) <= most)
        return low;
    // Forty geometric steps find the magnitude, twenty more the value to 2^-20 of it.
    for (int i = 0; i < 60; ++i) {
        const double middle = i < 40 ? std::sqrt(std::max(low, 1e-20) * high) : 0.5 * (low + high);
        (mean(middle) > most ? low : high) = middle;
    }
    return high;
}

void spend_components(const ClusterRounds& rounds, double most, const Progress& progress,
                      RateBudget& rate_budget, ClusterState& state) {
    ClusterState best = state;
    double least = std::numeric_limits<double>::infinity(), best_multiplier = 0;
    for (int r = 0; r < tuning::kMultiplierRounds; ++r) {
        progress.update(static_cast<double>(r) / tuning::kMultiplierRounds);
        rate_budget.component_multiplier = 0;
        rounds.refit(state, rate_budget); // updates the spectra
        rate_budget.component_multiplier = component_multiplier(state, rate_budget, most);
        rounds.refit(state, rate_budget);
        double paid = 0;
        for (const ClusterFit& fit : state.fits)
            paid += fit.significance * rate_budget.component_multiplier *
                    static_cast<double>(fit.plan.bits.size());
        if (state.cost - paid < least) {
            least = state.cost - paid;
            best = state;
            best_multiplier = rate_budget.component_multiplier;
        }
        rounds.reassign(state);
    }
    state = std::move(best);
    rate_budget.component_multiplier = best_multiplier;
}

} // namespace prt
