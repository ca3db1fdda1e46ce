#pragma once

// Contrast errors of lamps.

#include "compress/metric/frame.h"
#include "compress/metric/point_scales.h"
#include "prt/compress/light_metric.h"
#include "prt/core/transfer_view.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Lamps as a viewer sees them, each alone: an error is relative to the local light plus a tenth of the
/// adaptation luminance (docs/math.md, section 4). Near a lamp, light is a thousand times brighter than on
/// the far wall, but an error of a tenth is equally visible on both. Clusters are searched in a logarithmic
/// space, where distance is contrast. Codes are chosen for the light itself, with a scale for each receiver
/// and lamp.
class SeenLamps {
public:
    /// `metric`: the cost of its sky is kept, and equals the cost of all lamps together. `significance`
    /// [receivers] sums to 1. Keeps a reference to `transfer`.
    SeenLamps(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
              int threads);

    /// Returns the transfer in which T of each lamp is replaced by T (log(1 + Y/a)/Y + a constant of the
    /// lamp), with Y the luminance of T.
    TransferView logarithmic() const;
    /// Cost of errors in the logarithmic space; also of errors of light at receivers with Y + a = 1.
    const LightMetric& metric() const { return metric_; }
    /// Returns a frame whose axes belong either to one lamp or to the sky: first the lamps, then the sky. It
    /// has the minimum number of axes for an added squared error of at most `max_dropped`.
    Frame frame(double max_dropped) const;
    /// Returns the scales of errors: along axes of lamps the root of 1 / (Y + a)² plus a fraction of 1 over
    /// the mean Y²; along the other axes the root of `sky_costs` [receivers].
    PointScales scales(const Frame& frame, std::span<const float> sky_costs) const;
    /// Returns the root mean squared contrast error of `approximation`, over receivers and lamps that are on.
    double contrast(const TransferView& approximation) const;

private:
    struct Lamp {
        std::size_t first, channels; ///< indices of coefficients in a vector
        double adaptation = 0;       ///< a: a tenth of the logarithmic mean over the lit receivers; 0: the
                                     ///< lamp is off
        double square = 0;           ///< mean of Y²
    };
    /// Computes adaptation and mean squares of all lamps.
    void measure_lamps();
    int shining() const; ///< number of lamps that are on
    double luminance(const Lamp& lamp, const float* vector) const;
    /// Returns the cost of a squared error of the luminance at luminance `y`.
    double cost(const Lamp& lamp, double y) const;
    /// Appends a lamp's axes to `frame`.
    void add_axes_of(const Lamp& lamp, Frame& frame) const;

    const TransferView& transfer_;
    std::span<const float> significance_;
    std::vector<Lamp> lamps_;
    std::optional<Frame> sky_; ///< frame of the sky's coefficients, if there is a sky
    LightMetric metric_;
};

} // namespace prt
