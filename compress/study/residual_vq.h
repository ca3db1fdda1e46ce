#pragma once

// Residual vector quantisation, the best of general-purpose compressors of vectors, for the sweep: where prt
// was built with faiss.

#include "prt/sweep.h"

namespace prt {

/// M codebooks of 256 rows for as many M as the sweep has sizes; nothing where prt was built without faiss.
std::vector<SweepCandidate> residual_vq_candidates(const Transfer& transfer, std::uint64_t seed);

} // namespace prt
