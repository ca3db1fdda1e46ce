#pragma once

#include <span>
#include <vector>

namespace prt {

/// How much each receiver counts: its share of all areas. Where no receiver has an area all count alike.
std::vector<float> significance_of(std::span<const float> areas);

} // namespace prt
