#pragma once

#include "clusters/cluster_rounds.h"
#include "prt/support/progress.h"

namespace prt {

/// One sweep of moves: clusters that gain most by being cut along their first direction, each with a pair
/// that loses least by becoming one, and some rounds. Keeps it, and returns true, where the cost fell by more
/// than the share `tolerance`.
bool split_and_merge(const ClusterRounds& rounds, const Spending& spending, double tolerance,
                     const Progress& progress, ClusterState& state);

/// As many clusters as are wanted: those that gain most are split in two, or pairs that lose least become
/// one, each at most once between two rounds. Where nothing is left to split there are fewer.
void resize(const ClusterRounds& rounds, const Spending& spending, std::size_t wanted, ClusterState& state);

} // namespace prt
