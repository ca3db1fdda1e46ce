#pragma once

// Compression methods from the literature and from other tools, with which reports compare the compressor of
// prt/compress/compress.h.

#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// Transfer after compression and decompression by one method, and the size of the compressed form.
struct BaselineResult {
    Transfer decoded;           ///< decompressed transfer, with the layout and the receivers of the input
    double payload_bytes = 0;   ///< bytes per receiver that a game binds as vertex attributes, rounded up to
                                ///< whole 32-bit words (`bound_bytes`)
    double table_bytes = 0;     ///< bytes of all data that receivers share: scales, means and directions
    double mean_components = 0; ///< number of values that the vertex shader multiplies by a color and adds
                                ///< per receiver; for `classic_cpca` the maximum over all clusters
};

/// Returns the size in bytes of a vertex attribute that holds `bytes` bytes: the next multiple of 4.
double bound_bytes(std::size_t bytes);

/// Keeps the first `bands` (at least 0) bands of each term and of each channel, and sets the other
/// coefficients to 0. Each kept coefficient is rounded to one signed byte, in units of its maximum magnitude
/// over all receivers. Terms of lamps are kept if `bands` is at least 1. `transfer` must have one output
/// (TransferLayout::outputs).
BaselineResult truncated_sh(const Transfer& transfer, int bands);

/// Settings of `classic_cpca`.
struct ClassicOptions {
    int clusters = 1;   ///< maximum number of clusters, at least 1; there are fewer if fewer receivers
                        ///< differ; D3DX used 1 cluster with 24 components by default
    int components = 0; ///< number of components of each cluster, at least 0; 0: only vector quantisation,
                        ///< each receiver is replaced by the mean of its cluster
    /// True: alternate between PCA in each cluster and reassignment of receivers to clusters (Sloan et al.
    /// 2003, section 4.2). False: compute PCA once, in the clusters of vector quantisation.
    bool iterate = true;
    std::uint64_t seed = 0; ///< seed of the initial clusters
    int threads = 0;        ///< number of threads; 0: all
};

/// Compresses `transfer` by clustered PCA as published, and decompresses it. Minimises the squared error of
/// coefficients, weighted by `areas` [receivers]; equal weights if all areas are 0. A cluster has fewer than
/// ClassicOptions::components components only if more would not reduce its error. Weights have 8 bits, in
/// units of the maximum magnitude of a weight of the same cluster and direction; means and directions are
/// float16. Throws the errors of `check_layout`, and `Cancelled` after a stop request.
BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress = {});

} // namespace prt
