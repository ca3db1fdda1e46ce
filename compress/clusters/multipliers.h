#pragma once

// Lagrange multipliers of rows and components.

#include "compress/clusters/cluster_rounds.h"
#include "prt/core/progress.h"

namespace prt {

/// Returns the multiplier of one more row in a cluster in a file whose bases count.
double row_multiplier(const ClusterState& state);

/// Returns the minimum multiplier of a component for which receivers have at most `most` components on
/// average, by bisection over the plans that the spectra of the clusters allow.
double component_multiplier(const ClusterState& state, RateBudget rate_budget, double most);

/// Lets clusters have different numbers of components, at most `most` on average. The multiplier is
/// determined again in each round, because multipliers move points, and points change multipliers. Leaves the
/// best round in `state` and its multiplier in `rate_budget`.
void spend_components(const ClusterRounds& rounds, double most, const Progress& progress,
                      RateBudget& rate_budget, ClusterState& state);

} // namespace prt
