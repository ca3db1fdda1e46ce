#pragma once

#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// A space in which Euclidean distance is error of exit radiance: y = analysis (T - origin), T = origin +
/// synthesis^T y, with axes in descending order of variance. Units are such that the mean of |dT|² by
/// significance in this space is the squared `expected_lit_rms`. Axes that carry next to nothing are left
/// out, so that colored transfer, whose channels are nearly dependent, costs little more than grey.
struct Frame {
    TransferLayout layout;
    std::size_t dimension = 0;     ///< axes that are kept
    std::vector<double> origin;    ///< [full]: the mean of all receivers but outliers
    std::vector<double> analysis;  ///< [dimension][full]
    std::vector<double> synthesis; ///< [dimension][full]
    std::vector<double> variances; ///< [full] along all axes, also those left out
    double dropped = 0;            ///< squared error of leaving axes out
    double scale = 1;              ///< of distances: 1 over the root of the mean squared exit radiance

    std::size_t full() const { return origin.size(); }
};

/// The frame of `transfer` with as few axes as leave a squared error of at most `most_dropped`.
/// `significance` [receivers] sums to 1.
Frame fit_frame(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
                double most_dropped, int threads);

/// Axes without which the squared error grows to at most `most`.
std::size_t axes_needed(const Frame& frame, double most);

/// Leaves out all but the first `dimension` axes.
void truncate(Frame& frame, std::size_t dimension);

} // namespace prt
