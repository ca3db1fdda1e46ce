#pragma once

#include "clusters/cluster_rounds.h"
#include "prt/support/progress.h"

namespace prt {

/// What one more row in a cluster costs in a file whose bases count.
double row_price(const ClusterState& state);

/// The least price of a component at which receivers have at most `most` components on average, by bisection
/// over the plans that the spectra of the clusters allow.
double component_price(const ClusterState& state, Spending spending, double most);

/// Lets clusters have different numbers of components, at most `most` on average: the price that does that is
/// found anew in each round, since prices move the points, and points the prices. Leaves the best round in
/// `state` and its price in `spending`.
void spend_components(const ClusterRounds& rounds, double most, const Progress& progress, Spending& spending,
                      ClusterState& state);

} // namespace prt
