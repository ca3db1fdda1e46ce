#pragma once

// The moving basis as a baseline of the compressor, with what its code takes. For the study; nothing else
// uses it.

#include "prt/baselines.h"
#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/support/progress.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace prt {

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
