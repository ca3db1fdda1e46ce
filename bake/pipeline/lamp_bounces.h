#pragma once

// Computes the last bounce of lamps at receivers with less noise than the bounces before it.

#include "bake/pipeline/lamp_rows.h"
#include "bake/surface_fit/noise_filter.h"

#include <span>
#include <vector>

namespace prt {

/// Light gathered by LampRows, [receivers][channels][columns]; `half` may be empty.
struct LastOfLampsGathered {
    std::span<const float> all, half;
};

/// Replaces the difference between `light` and `unbounced`, both [receivers][channels][columns], by the
/// gathered light. Filters the gathered light if `filter` and `half` are given. `left_out` [receivers]:
/// receivers whose light is not gathered by their own rays. Returns the remaining noise of each of `lamps`,
/// as the root of the sum of squares over the surface; empty if it is unknown.
std::vector<double> take_last_of_lamps(const LastOfLampsGathered& gathered, const std::vector<bool>& left_out,
                                       const NoiseFilter* filter, std::size_t lamps,
                                       const Transfer& unbounced, Transfer& light);

} // namespace prt
