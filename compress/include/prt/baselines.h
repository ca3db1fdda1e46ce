#pragma once

// What this compressor is measured against: the methods of the literature and of the tools of their time. For
// reports; nothing else uses them.

#include "prt/support/progress.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// A transfer after coding and decoding by some method, and what the code takes.
struct BaselineResult {
    Transfer decoded;
    double payload_bytes = 0;   ///< per receiver, as a game binds it: whole 32-bit words (`bound_bytes`)
    double table_bytes = 0;     ///< in all
    double mean_components = 0; ///< per receiver; each is a multiply-add of a color
};

/// `bytes` of a receiver, each a code, in the whole 32-bit words that a vertex attribute takes.
double bound_bytes(std::size_t bytes);

/// The first `bands` bands, a byte per coefficient over its largest value.
BaselineResult truncated_sh(const Transfer& transfer, int bands);

struct ClassicOptions {
    int clusters = 1; ///< 1 with 24 components was the default of D3DX
    int components = 0;
    /// Local PCA and reassignment in turn (Sloan et al. 2003, section 4.2), else PCA once in the clusters of
    /// vector quantisation. No components: vector quantisation alone.
    bool iterate = true;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// Clustered PCA as published: least squared error of coefficients, the same number of components everywhere,
/// weights of 8 bits over each direction's largest, means and directions as float16.
BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress = {});

} // namespace prt
