#pragma once

// Residual vector quantisation, the best of general-purpose compressors of vectors, for the sweep.

#include "compress/study/sweep.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Returns M codebooks of 256 rows, for each size of the sweep; empty if there are fewer receivers than rows.
/// The candidates keep a reference to `transfer`.
std::vector<SweepCandidate> residual_vq_candidates(const Transfer& transfer, std::uint64_t seed);

} // namespace prt
