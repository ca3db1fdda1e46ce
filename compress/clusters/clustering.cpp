// Controls clustered PCA (Sloan, Hall, Hart and Snyder 2003): start, growth, rounds, moves, multipliers.

#include "compress/clusters/clustering.h"

#include "compress/clusters/kmeans.h"
#include "compress/clusters/moves.h"
#include "compress/clusters/multipliers.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Returns the error with the state's components, without quantisation and multipliers.
double squared_error(const ClusterState& state) {
    double error = 0;
    for (std::size_t k = 0; k < state.fits.size(); ++k)
        error += cluster_cost(state.moments.view(k),
                              {.component_limit = static_cast<int>(state.fits[k].plan.bits.size())});
    return error;
}

bool any_has(const ClusterState& state, int components) {
    return std::any_of(state.fits.begin(), state.fits.end(), [&](const ClusterFit& fit) {
        return static_cast<int>(fit.plan.bits.size()) >= components;
    });
}

/// Adds components one at a time, with some rounds each.
void grow_components(const ClusterRounds& rounds, RateBudget rate_budget, const Progress& progress,
                     ClusterState& state) {
    const int full = rate_budget.component_limit;
    for (rate_budget.component_limit = 1; rate_budget.component_limit < full; ++rate_budget.component_limit) {
        for (int r = 0; r < tuning::kRoundsPerComponent; ++r) {
            progress.update(static_cast<double>(rate_budget.component_limit) / full);
            rounds.round(state, rate_budget);
        }
        if (!any_has(state, rate_budget.component_limit))
            break; // no cluster would use more components
    }
}

/// Performs rounds until convergence.
void converge(const ClusterRounds& rounds, const ClusteringSchedule& schedule, const RateBudget& rate_budget,
              const Progress& progress, ClusterState& state, std::vector<double>* history) {
    ClusterState best = state;
    best.cost = std::numeric_limits<double>::infinity();
    for (int r = 0; r < schedule.max_rounds; ++r) {
        progress.update(1 - std::pow(0.9, r)); // the number of rounds is unknown
        rounds.refit(state, rate_budget);
        rounds.tell(ClusteringRound{rate_budget.component_limit, state.cost});
        const bool better = state.cost < best.cost;
        if (history && better)
            history->push_back(squared_error(state));
        const bool converged = !(state.cost < best.cost * (1 - schedule.tolerance));
        if (better)
            best = state;
        if (converged)
            break;
        rounds.reassign(state);
    }
    state = std::move(best);
}

/// Performs rounds, then moves while they reduce the cost, then rounds again.
void improve(const ClusterRounds& rounds, const ClusteringSchedule& schedule, const RateBudget& rate_budget,
             const Progress& progress, ClusterState& state, std::vector<double>& history) {
    converge(rounds, schedule, rate_budget, progress.range(0, tuning::kFirstRoundsAt), state, &history);
    const double sweep = (tuning::kMovesAt - tuning::kFirstRoundsAt) / schedule.max_move_sweeps;
    for (int m = 0; m < schedule.max_move_sweeps; ++m)
        if (!split_and_merge(
                rounds, rate_budget, schedule.tolerance,
                progress.range(tuning::kFirstRoundsAt + sweep * m, tuning::kFirstRoundsAt + sweep * (m + 1)),
                state))
            break;
    converge(rounds, schedule, rate_budget, progress.range(tuning::kMovesAt, 1), state, nullptr);
}

std::size_t clusters_in(std::span<const std::uint32_t> numbers) {
    return 1 + *std::max_element(numbers.begin(), numbers.end());
}

} // namespace

Clustering cluster_points(const PointBlocks& points, std::span<const float> significance,
                          const ClusteringOptions& options, std::mt19937_64& random,
                          const Progress& progress) {
    const ClusterRounds rounds{points, significance, options.trace, options.threads};
    ClusterState state =
        options.start.empty()
            ? rounds.start(vector_quantise(points, significance, options.clusters, random, options.threads,
                                           progress.range(0, tuning::kSeedsAt)))
            : rounds.start(options.start, clusters_in(options.start));
    rounds.tell(ClustersSeeded{state.fits.size(), points.dimension});
    RateBudget rate_budget = options.rate_budget;
    // With a limit on the mean, clusters differ only at the end: earlier, clusters with many components would
    // absorb the points of others.
    const bool limited = options.mean_components > 0;
    if (limited)
        rate_budget.component_limit =
            std::min(rate_budget.component_limit, std::max(1, static_cast<int>(options.mean_components)));
    if (!options.start.empty())
        resize(rounds, rate_budget, options.clusters, state);
    else if (options.schedule.grow)
        grow_components(rounds, rate_budget, progress.range(tuning::kSeedsAt, tuning::kComponentsGrownAt),
                        state);
    rounds.refit(state, rate_budget);
    if (options.rows_cost)
        rate_budget.row_multiplier = row_multiplier(state);
    Clustering result;
    improve(rounds, options.schedule, rate_budget,
            progress.range(tuning::kComponentsGrownAt, tuning::kImprovedAt), state, result.history);
    if (limited) {
        rate_budget.component_limit = options.rate_budget.component_limit;
        spend_components(rounds, options.mean_components, progress.range(tuning::kImprovedAt, 1), rate_budget,
                         state);
    }
    // Points that came and went have left rounding errors in the moments, outliers the largest.
    state.moments.build(points, significance, state.clusters, options.threads);
    if (limited) { // the limit must hold for the final clusters
        rate_budget.component_multiplier = 0;
        rounds.refit(state, rate_budget);
        rate_budget.component_multiplier = component_multiplier(state, rate_budget, options.mean_components);
    }
    rounds.refit(state, rate_budget);
    result.clusters = std::move(state.clusters);
    result.fits = std::move(state.fits);
    result.cost = state.cost;
    return result;
}

} // namespace prt
