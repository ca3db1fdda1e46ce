// Computes costs of errors under skies and lamps (docs/math.md, section 4).

#include "compress/metric/seen_light.h"

#include "compress/metric/significance.h"

namespace prt {
namespace {

/// Returns significance times costs, of sum 1.
std::vector<float> weighted(std::span<const float> significance, std::span<const float> costs) {
    double sum = 0;
    for (std::size_t p = 0; p < costs.size(); ++p)
        sum += static_cast<double>(significance[p]) * static_cast<double>(costs[p]);
    std::vector<float> result(significance.begin(), significance.end());
    for (std::size_t p = 0; p < costs.size() && sum > 0; ++p)
        result[p] = static_cast<float>(static_cast<double>(significance[p] * costs[p]) / sum);
    return result;
}

} // namespace

SeenLight::SeenLight(const TransferView& transfer, std::span<const float> areas, const LightMetric& metric,
                     int threads)
    : significance_(significance_of(areas)), metric_(metric), sky_costs_(significance_.size(), 1.0f) {
    const TransferLayout& layout = transfer.layout();
    if (layout.outputs == 1 && !layout.distant_terms().empty())
        sky_costs_ = sky_.emplace(transfer, significance_, metric_, threads).costs();
    if (layout.outputs == 1 && layout.lamps() > 0)
        lamps_.emplace(transfer, significance_, metric_, threads);
    weights_ = weighted(significance_, sky_costs_);
}

} // namespace prt
