#pragma once

// The last bounce of lamps at receivers, with less noise than those before it.

#include "lamps/lamp_rows.h"
#include "surface/noise_filter.h"

#include <span>
#include <vector>

namespace prt {

/// What LampRows gathered, [receivers][channels][columns]; `half` may be empty.
struct LastOfLampsGathered {
    std::span<const float> all, half;
};

/// Replaces what `light` has more than `unbounced`, [receivers][channels][columns] both, by what was
/// gathered, and filters that where there is a filter and a half. `left_out` [receivers]: those whose light
/// is not what their own rays gathered. Returns the noise that is left of each of `lamps`, root of the sum of
/// squares over the surface; nothing where it is not known.
std::vector<double> take_last_of_lamps(const LastOfLampsGathered& gathered, const std::vector<bool>& left_out,
                                       const NoiseFilter* filter, std::size_t lamps,
                                       const Transfer& unbounced, Transfer& light);

} // namespace prt
