// Converts areas of receivers to significance, the a_p of docs/math.md, eq. 21.

#include "compress/metric/significance.h"

#include <algorithm>

namespace prt {

std::vector<float> significance_of(std::span<const float> areas) {
    double total = 0;
    for (const float area : areas)
        total += static_cast<double>(std::max(area, 0.0f));
    std::vector<float> significance;
    significance.reserve(areas.size());
    for (const float area : areas)
        significance.push_back(static_cast<float>(total > 0
                                                      ? static_cast<double>(std::max(area, 0.0f)) / total
                                                      : 1.0 / static_cast<double>(areas.size())));
    return significance;
}

} // namespace prt
