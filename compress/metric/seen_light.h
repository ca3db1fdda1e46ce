#pragma once

// Cost and visibility of errors at each receiver.

#include "compress/metric/seen_lamps.h"
#include "compress/metric/sky_contrast.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Cost of errors at each receiver, and their visibility. Depends only on the transfer, the areas and the
/// metric: a search computes it once for all trials. Keeps a reference to `transfer`.
class SeenLight {
public:
    /// `areas` [receivers].
    SeenLight(const TransferView& transfer, std::span<const float> areas, const LightMetric& metric,
              int threads);
    SeenLight(const SeenLight&) = delete;
    SeenLight& operator=(const SeenLight&) = delete;

    /// [receivers] fractions of the area, of sum 1.
    const std::vector<float>& significance() const { return significance_; }
    /// [receivers] weight of a squared error in clusters and codes, of sum 1: significance; without lamps
    /// also multiplied by the costs of `SkyContrast`, which are then not part of the points.
    const std::vector<float>& weights() const { return lamps_ ? significance_ : weights_; }
    /// [receivers] `SkyContrast::costs`; all 1 without skies.
    const std::vector<float>& sky_costs() const { return sky_costs_; }
    const LightMetric& metric() const { return metric_; }
    /// Set if there are skies and a single output.
    const std::optional<SkyContrast>& sky() const { return sky_; }
    /// Set if there are lamps and a single output.
    const std::optional<SeenLamps>& lamps() const { return lamps_; }

private:
    std::vector<float> significance_;
    LightMetric metric_;
    std::optional<SkyContrast> sky_;
    std::optional<SeenLamps> lamps_;
    std::vector<float> sky_costs_, weights_;
};

} // namespace prt
