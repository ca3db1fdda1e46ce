#pragma once

// Finds vertices that a mesh contains several times at one position.

#include "bake/scene/receivers.h"
#include "bake/scene/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Returns for each receiver the first receiver of its node with the same position, the same side of the
/// surface and, up to rounding, the same normal: [receivers]. The first `fronts` are corners of `surfaces`;
/// `back` [fronts], or empty, as in TransportReceivers. A receiver without such a duplicate is its own first.
std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces, const Receivers& receivers,
                                           std::size_t fronts, std::span<const std::uint32_t> back = {});

} // namespace prt
