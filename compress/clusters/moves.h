#pragma once

// Split and merge moves of clusters.

#include "compress/clusters/cluster_rounds.h"
#include "prt/core/progress.h"

namespace prt {

/// Performs one sweep of moves and some rounds: clusters with the largest gain are split along their first
/// direction, each in exchange for the merge of a pair with the smallest loss. Keeps the result and returns
/// true if the cost decreased by more than the fraction `tolerance`.
bool split_and_merge(const ClusterRounds& rounds, const RateBudget& rate_budget, double tolerance,
                     const Progress& progress, ClusterState& state);

/// Changes the number of clusters to `wanted`: splits those with the largest gain, or merges pairs with the
/// smallest loss, each at most once between two rounds. The result has fewer clusters if nothing is left to
/// split.
void resize(const ClusterRounds& rounds, const RateBudget& rate_budget, std::size_t wanted,
            ClusterState& state);

} // namespace prt
