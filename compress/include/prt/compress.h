#pragma once

// The compressor: clustered PCA of transfer vectors (Sloan, Hall, Hart and Snyder 2003, "Clustered Principal
// Components for Precomputed Radiance Transfer").

#include "prt/clustered_transfer.h"
#include "prt/progress.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct CompressOptions {
    int clusters = 64;
    int components = 8; ///< per cluster, at most the dimension of the transfer vectors
    WeightFormat weights = WeightFormat::snorm8;
    std::uint64_t seed = 0;
    int threads = 0; ///< 0: all
    int max_iterations = 200;
    /// Iteration ends when the squared error falls by less than this share of itself in one round.
    double tolerance = 1e-4;
};

struct CompressStatistics {
    /// Relative L2 error after each round of clustered PCA, before weights are quantised; never increases.
    std::vector<double> relative_l2_by_iteration;
    double relative_l2 = 0; ///< of what is returned, quantised weights included
    int clusters = 0;       ///< that hold receivers; empty ones are dropped
    double seconds = 0;
    std::size_t bytes_per_receiver = 0; ///< cluster and weights
    std::size_t basis_bytes = 0;        ///< means, directions, scales
};

struct CompressResult {
    ClusteredTransfer transfer;
    CompressStatistics statistics;
};

/// Compresses `transfer`; `areas` [receivers] weight the error. Receivers of area 0 are coded but do not
/// count. Deterministic from the seed, whatever the number of threads. Thread-safe. Throws `Error` for
/// options outside their range and transfer that is not finite, and `Cancelled`.
CompressResult compress(const Transfer& transfer, std::span<const float> areas,
                        const CompressOptions& options, const Progress& progress = {});

} // namespace prt
