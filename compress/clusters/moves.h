#pragma once

#include "clusters/cluster_rounds.h"
#include "prt/support/progress.h"

namespace prt {

/// One sweep of moves: clusters that gain most by being cut along their first direction, each with a pair
/// that loses least by becoming one, and some rounds. Keeps it, and returns true, where the cost fell by more
/// than the share `tolerance`.
bool split_and_merge(const ClusterRounds& rounds, const Spending& spending, double tolerance,
                     const Progress& progress, ClusterState& state);

} // namespace prt
