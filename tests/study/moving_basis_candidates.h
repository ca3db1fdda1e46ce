#pragma once

// A basis that moves, at the settings of the sweep.

#include "compress/study/sweep.h"

#include <vector>

namespace prt {

inline constexpr const char* kMovingBasis = "moving basis";

/// Return candidates for the errors that `sweep` uses without a metric in its options. `by_bytes`: grids that
/// fit each of `kSweepBytes`; `by_components`: grids of at most `kSweepClusters` nodes. Empty if `surface`
/// has no positions. The candidates keep references to `transfer` and to the data of `surface`.
std::vector<SweepCandidate> moving_basis_candidates(const Transfer& transfer, const ReceiverSurface& surface,
                                                    int threads);

} // namespace prt
