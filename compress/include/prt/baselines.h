#pragma once

// What this compressor is measured against: the methods of the literature and of the tools of their time. For
// reports; nothing else uses them.

#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/support/progress.h"
#include "prt/transfer.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
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

struct MovingBasisOptions {
    int components = 4;   ///< of a receiver, at most
    int weight_bits = 32; ///< of a receiver, all components together; what carries more has more of them
    /// At most, in all. The grid is the finest that there is room for.
    double table_bytes = std::numeric_limits<double>::infinity();
    std::size_t nodes = std::numeric_limits<std::size_t>::max(); ///< of the grid, at most
    LightMetric metric = {};                                     ///< what an error costs
    int threads = 0;
};

struct MovingBasisResult {
    BaselineResult result;
    std::size_t nodes = 0;
};

/// A mean and a basis at every node of a regular grid over the positions, between which is interpolated
/// linearly, and weights of each receiver (Silvennoinen and Sloan 2021, "Moving Basis Decomposition for
/// Precomputed Light Transport"; docs/math.md, section 4): nothing jumps. `mean_components` are 8 for every
/// component and for the mean: each is blended from 8 corners. Nothing where no grid keeps to the bytes.
/// `surface` has areas and positions.
std::optional<MovingBasisResult> moving_basis(const Transfer& transfer, const ReceiverSurface& surface,
                                              const MovingBasisOptions& options,
                                              const Progress& progress = {});

} // namespace prt
