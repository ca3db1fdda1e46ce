#pragma once

#include "clusters/points.h"
#include "metric/frame.h"
#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Lamps as a viewer sees them, one alone: an error of light counts against the light that is there and a
/// tenth of what eyes adapt to (docs/math.md, section 4). Beside a lamp light is a thousand times as bright
/// as on the far wall, and an error of a tenth is as visible on both. Clusters are looked for in a space of
/// logarithms, where distance is contrast; codes are chosen by the light itself, with a scale for each
/// receiver and lamp.
class SeenLamps {
public:
    /// `metric`: its sky counts as before, and as much as all lamps together. `significance` [receivers] sums
    /// to 1. Keeps a reference to `transfer`.
    SeenLamps(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
              int threads);

    /// The transfer with T (log(1 + Y/a)/Y + a constant of the lamp) in the place of T for lamps, Y the
    /// luminance of T.
    TransferView logarithmic() const;
    /// What errors cost there; and those of light where Y + a is 1.
    const LightMetric& metric() const { return metric_; }
    /// Axes of each lamp and then of the sky, which do not mix. As few as add at most `most_dropped` in
    /// squared error by being left out.
    Frame frame(double most_dropped) const;
    /// The root of 1 / (Y + a)² and a share of 1 over the mean Y² along axes of lamps; of `sky_costs`
    /// [receivers] along the others.
    PointScales scales(const Frame& frame, std::span<const float> sky_costs) const;
    /// The root of the mean squared contrast error of `approximation`, over receivers and lamps that shine.
    double contrast(const TransferView& approximation) const;

private:
    struct Lamp {
        std::size_t first, channels; ///< numbers in a vector
        double adaptation = 0;       ///< a: a tenth of the logarithmic mean over what it lights; 0: it is off
        double square = 0;           ///< mean of Y²
    };
    /// Adaptation and squares of all.
    void measure_lamps();
    int shining() const; ///< lamps that are on
    double luminance(const Lamp& lamp, const float* vector) const;
    /// What a squared error of the luminance counts where it is `y`.
    double cost(const Lamp& lamp, double y) const;
    /// A lamp's axes behind those of `frame`.
    void add_axes_of(const Lamp& lamp, Frame& frame) const;

    const TransferView& transfer_;
    std::span<const float> significance_;
    std::vector<Lamp> lamps_;
    std::optional<Frame> sky_; ///< of the columns of the sky, where there is one
    LightMetric metric_;
};

} // namespace prt
