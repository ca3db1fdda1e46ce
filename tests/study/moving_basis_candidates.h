#pragma once

// A basis that moves, at the settings of the sweep.

#include "prt/sweep.h"

#include <vector>

namespace prt {

inline constexpr const char* kMovingBasis = "moving basis";

/// For the errors that `sweep` compresses for without a metric in its options. `by_bytes`: grids that keep to
/// each of `kSweepBytes`; `by_components`: grids of at most `kSweepClusters` nodes. Nothing where `surface`
/// has no positions. They keep references to `transfer` and to what `surface` refers to.
std::vector<SweepCandidate> moving_basis_candidates(const Transfer& transfer, const ReceiverSurface& surface,
                                                    int threads);

} // namespace prt
