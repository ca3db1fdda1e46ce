#pragma once

#include "metric/seen_lamps.h"
#include "metric/sky_contrast.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// What errors cost at each receiver, and what a viewer sees of them. Depends on the transfer, the areas and
/// the metric alone: a search makes it once for all of its trials. Keeps a reference to `transfer`.
class SeenLight {
public:
    /// `areas` [receivers].
    SeenLight(const TransferView& transfer, std::span<const float> areas, const LightMetric& metric,
              int threads);
    SeenLight(const SeenLight&) = delete;
    SeenLight& operator=(const SeenLight&) = delete;

    /// [receivers] shares of the area, of sum 1.
    const std::vector<float>& significance() const { return significance_; }
    /// [receivers] what a squared error counts in clusters and codes, of sum 1: significance, and without
    /// lamps times the costs of `SkyContrast`, which then are no part of points.
    const std::vector<float>& weights() const { return lamps_ ? significance_ : weights_; }
    /// [receivers] `SkyContrast::costs`; all 1 where there is none.
    const std::vector<float>& sky_costs() const { return sky_costs_; }
    const LightMetric& metric() const { return metric_; }
    /// Where there are skies, and one output.
    const std::optional<SkyContrast>& sky() const { return sky_; }
    /// Where there are lamps, and one output.
    const std::optional<SeenLamps>& lamps() const { return lamps_; }

private:
    std::vector<float> significance_;
    LightMetric metric_;
    std::optional<SkyContrast> sky_;
    std::optional<SeenLamps> lamps_;
    std::vector<float> sky_costs_, weights_;
};

} // namespace prt
