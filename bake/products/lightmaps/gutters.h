#pragma once

// Values of texels between charts.

#include "prt/bake/texels.h"

#include <span>
#include <vector>

namespace prt {

/// Replaces the values of texels that are not `filled` by the mean of their filled neighbours, ring by ring
/// until all are filled: `values` [texels][stride]. Filters then read no unmeasured texel.
void fill_gutters(const Atlas& atlas, std::vector<bool> filled, std::span<float> values, std::size_t stride);

} // namespace prt
