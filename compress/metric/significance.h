#pragma once

// Weights of receivers.

#include <span>
#include <vector>

namespace prt {

/// Returns the weight of each receiver: its fraction of the total area. All weights are equal if the total
/// area is 0.
std::vector<float> significance_of(std::span<const float> areas);

} // namespace prt
