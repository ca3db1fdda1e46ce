#include "metric/receiver_weights.h"

#include <algorithm>

namespace prt {

std::vector<float> receiver_weights(std::span<const float> areas) {
    double total = 0;
    for (const float area : areas)
        total += static_cast<double>(std::max(area, 0.0f));
    std::vector<float> weights;
    for (const float area : areas)
        weights.push_back(static_cast<float>(total > 0 ? static_cast<double>(std::max(area, 0.0f)) / total
                                                       : 1.0 / static_cast<double>(areas.size())));
    return weights;
}

} // namespace prt
