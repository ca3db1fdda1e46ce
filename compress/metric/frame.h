#pragma once

// Principal axes of transfer in the metric of light.

#include "prt/compress/light_metric.h"
#include "prt/core/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// A space in which Euclidean distance is error of exit radiance: y = analysis (T - origin), T = origin +
/// synthesis^T y, with axes in descending order of variance. Units are chosen so that the mean of |dT|²,
/// weighted by significance, is the squared `expected_lit_rms`. Axes that carry almost no variance are
/// dropped, so that colored transfer, whose channels are nearly dependent, costs little more than grey.
struct Frame {
    TransferLayout layout;
    std::size_t dimension = 0;     ///< number of kept axes
    std::vector<double> origin;    ///< [full]: mean of all receivers except outliers
    std::vector<double> analysis;  ///< [dimension][full]
    std::vector<double> synthesis; ///< [dimension][full]
    std::vector<double> variances; ///< [full] along all axes, including dropped ones
    double dropped = 0;            ///< squared error of dropping axes
    double scale = 1;              ///< scale of distances: 1 over the root mean square exit radiance

    std::size_t full() const { return origin.size(); }
};

/// Returns the frame of `transfer` with the minimum number of axes for a squared error of at most
/// `max_dropped`. `significance` [receivers] sums to 1.
Frame fit_frame(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
                double max_dropped, int threads);

/// Returns the number of axes needed for a squared error of at most `most`.
std::size_t axes_needed(const Frame& frame, double most);

/// Drops all but the first `dimension` axes.
void truncate(Frame& frame, std::size_t dimension);

} // namespace prt
