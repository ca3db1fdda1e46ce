#pragma once

// Contrast errors under skies.

#include "prt/compress/light_metric.h"
#include "prt/core/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Contrast of errors under skies: an error of exit radiance relative to the mean radiance of the receiver
/// plus a tenth of the logarithmic mean, as in `VisibleError` for one sky (docs/math.md, section 4).
class SkyContrast {
public:
    /// `metric`: mean lighting; its lamps are ignored. `significance` [receivers] sums to 1. Keeps references
    /// to `transfer`, `significance` and `metric`.
    SkyContrast(const TransferView& transfer, std::span<const float> significance, const LightMetric& metric,
                int threads);

    /// Returns the cost of a squared error of the sky's light at each receiver, [receivers], relative to the
    /// mean of the squared light: 1 - s + s mean(Y²) / (Y + a)², with s = tuning::kSkyContrastShare. All 1 if
    /// nothing is lit.
    std::vector<float> costs() const;
    /// Returns the root mean squared contrast error of `approximation`.
    double contrast(const TransferView& approximation) const;

private:
    const TransferView& transfer_;
    std::span<const float> significance_;
    const LightMetric& metric_;
    int threads_;
    std::vector<double> luminance_; ///< [receivers] Y: root of the expected squared light
    double adaptation_ = 0;         ///< a
    double mean_square_ = 0;        ///< mean of Y²
};

} // namespace prt
