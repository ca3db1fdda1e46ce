#pragma once

#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Contrast of errors under skies: an error of exit radiance over the radiance that the receiver has on
/// average and a tenth of its logarithmic mean, as `VisibleError` has it for one sky (docs/math.md, section
/// 4).
class SkyContrast {
public:
    /// `metric`: mean lighting, of which lamps are left out. `significance` [receivers] sums to 1. Keeps
    /// references to `transfer`, `significance` and `metric`.
    SkyContrast(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
                int threads);

    /// Cost of a squared error of the sky's light at each receiver, [receivers], relative to the mean of the
    /// squared light: 1 - s + s mean(Y²) / (Y + a)², with s = tuning::kSkyContrastShare. All 1 where nothing
    /// is lit.
    std::vector<float> costs() const;
    /// Root of the mean squared contrast error of `approximation`.
    double contrast(const TransferView& approximation) const;

private:
    const TransferView& transfer_;
    std::span<const float> significance_;
    const LightMetric& metric_;
    int threads_;
    std::vector<double> luminance_; ///< [receivers] Y: root of the expected squared light
    double adaptation_ = 0;         ///< a
    double mean_square_ = 0;        ///< of Y
};

} // namespace prt
