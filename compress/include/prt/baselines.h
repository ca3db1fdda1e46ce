#pragma once

// Reference methods from the literature and from other tools, for comparisons with this compressor in
// reports.

#include "prt/support/progress.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// Transfer after coding and decoding by some method, and the size of the code.
struct BaselineResult {
    Transfer decoded;
    double payload_bytes = 0;   ///< per receiver, as a game binds it: whole 32-bit words (`bound_bytes`)
    double table_bytes = 0;     ///< total
    double mean_components = 0; ///< per receiver; each costs one multiply-add of a color
};

/// Returns the size of `bytes` bytes of a receiver as a vertex attribute: rounded up to whole 32-bit words.
double bound_bytes(std::size_t bytes);

/// Stores the first `bands` bands with one byte per coefficient, relative to the maximum of that coefficient
/// over all receivers.
BaselineResult truncated_sh(const Transfer& transfer, int bands);

/// Settings of `classic_cpca`.
struct ClassicOptions {
    int clusters = 1;   ///< number of clusters; 1 cluster with 24 components was the default of D3DX
    int components = 0; ///< per cluster; 0: vector quantisation only
    /// True: alternate local PCA and reassignment (Sloan et al. 2003, section 4.2). False: compute PCA once
    /// in the clusters of vector quantisation.
    bool iterate = true;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// Compresses by clustered PCA as published: it minimises the squared error of coefficients, with the same
/// number of components in all clusters. Weights have 8 bits, relative to the maximum of each direction;
/// means and directions are float16.
BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress = {});

} // namespace prt
