#pragma once

#include "prt/texels.h"

#include <span>
#include <vector>

namespace prt {

/// Gives texels that are not `filled` the mean of their neighbours that are, ring by ring until all are:
/// `values` [texels][stride]. Filters then meet no texel that nobody measured.
void fill_gutters(const Atlas& atlas, std::vector<bool> filled, std::span<float> values, std::size_t stride);

} // namespace prt
