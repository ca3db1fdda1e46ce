#pragma once

// Lagrange multipliers of rows and components.

#include "clusters/cluster_rounds.h"
#include "prt/support/progress.h"

namespace prt {

/// Returns the price of one more row in a cluster in a file whose bases count.
double row_price(const ClusterState& state);

/// Returns the minimum price of a component for which receivers have at most `most` components on average, by
/// bisection over the plans that the spectra of the clusters allow.
double component_price(const ClusterState& state, Spending spending, double most);

/// Lets clusters have different numbers of components, at most `most` on average. The price is determined
/// again in each round, because prices move points, and points change prices. Leaves the best round in
/// `state` and its price in `spending`.
void spend_components(const ClusterRounds& rounds, double most, const Progress& progress, Spending& spending,
                      ClusterState& state);

} // namespace prt
