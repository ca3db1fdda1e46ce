#pragma once

// Vertices that a mesh has several times at one place.

#include "prt/receivers.h"
#include "prt/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// For each receiver the first one of its node with the same position and side of the surface, and the same
/// normal to rounding: [receivers]. The first `fronts` are corners of `surfaces`; `back` [fronts], or empty,
/// as in TransportReceivers. Others are alone.
std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces, const Receivers& receivers,
                                           std::size_t fronts, std::span<const std::uint32_t> back = {});

} // namespace prt
