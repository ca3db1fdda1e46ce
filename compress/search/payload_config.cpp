// Bytes per receiver and shader operations of a payload configuration.

#include "compress/search/payload_config.h"

#include <algorithm>
#include <numeric>

namespace prt {

double payload_bytes(WeightFormat format, int payload) {
    return format == WeightFormat::packed ? 4.0 * payload : 4 + 16.0 * payload;
}

int payload_of(const WeightCoding& preset, std::size_t dimension) {
    if (preset.format != WeightFormat::packed)
        return (std::min(preset.components, static_cast<int>(dimension)) + 3) / 4;
    const int bits = preset.fixed_bits.empty()
                         ? preset.bits
                         : std::accumulate(preset.fixed_bits.begin(), preset.fixed_bits.end(), 0);
    return (preset.cluster_bits + bits + 31) / 32;
}

int predictor_rows_of(PredictorChoice predictors, const ReceiverSurface& surface) {
    const int normal = surface.normals.empty() ? 0 : 3, position = surface.positions.empty() ? 0 : 3;
    switch (predictors) {
    case PredictorChoice::none:
        return 0;
    case PredictorChoice::normal:
        return normal;
    case PredictorChoice::normal_and_position:
        break;
    }
    return normal + position;
}

} // namespace prt
