#pragma once

// The moving basis as a baseline of the compressor, including its code size. Used only by the study.

#include "compress/study/baselines.h"
#include "prt/compress/light_metric.h"
#include "prt/compress/receiver_surface.h"
#include "prt/core/progress.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace prt {

struct MovingBasisOptions {
    int components = 4;   ///< maximum per receiver
    int weight_bits = 32; ///< bits of a receiver for all components; components with more energy get more
                          ///< bits
    /// Maximum size of all tables. The grid is the finest that fits.
    double table_bytes = std::numeric_limits<double>::infinity();
    std::size_t nodes = std::numeric_limits<std::size_t>::max(); ///< maximum number of nodes of the grid
    LightMetric metric = {};                                     ///< cost of an error
    int threads = 0;
};

struct MovingBasisResult {
    BaselineResult result;
    std::size_t nodes = 0;
};

/// Fits a mean and a basis at every node of a regular grid over the positions, with linear interpolation
/// between nodes, and weights of each receiver (Silvennoinen and Sloan 2021, "Moving Basis Decomposition for
/// Precomputed Light Transport"; docs/math.md, section 4): the result is continuous. `mean_components` are 8
/// for every component and for the mean: each is blended from 8 corners. Empty if no grid fits the size.
/// `surface` needs areas and positions.
std::optional<MovingBasisResult> moving_basis(const Transfer& transfer, const ReceiverSurface& surface,
                                              const MovingBasisOptions& options,
                                              const Progress& progress = {});

} // namespace prt
