#pragma once

#include <span>
#include <vector>

namespace prt {

/// Areas scaled to the sum 1. Where no receiver has an area all count alike.
std::vector<float> receiver_weights(std::span<const float> areas);

} // namespace prt
