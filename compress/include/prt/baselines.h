#pragma once

// Reference methods from the literature and from tools, to which this compressor is compared. Used for
// reports only.

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

/// Rounds `bytes` of a receiver up to the whole 32-bit words that a vertex attribute takes.
double bound_bytes(std::size_t bytes);

/// Keeps the first `bands` bands, with one byte per coefficient relative to the coefficient's maximum.
BaselineResult truncated_sh(const Transfer& transfer, int bands);

struct ClassicOptions {
    int clusters = 1; ///< 1 cluster with 24 components was the default of D3DX
    int components = 0;
    /// True: alternate local PCA and reassignment (Sloan et al. 2003, section 4.2); false: PCA once in the
    /// clusters of vector quantisation. With 0 components: vector quantisation only.
    bool iterate = true;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// Compresses by clustered PCA as published: least squared error of coefficients, the same number of
/// components in all clusters, 8-bit weights relative to each direction's maximum, means and directions as
/// float16.
BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress = {});

} // namespace prt
