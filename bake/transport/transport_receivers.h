#pragma once

// Receivers on both sides of surfaces.

#include "prt/receivers.h"
#include "prt/surfaces.h"
#include "scene/alike_receivers.h"

#include <cstdint>
#include <vector>

namespace prt {

inline constexpr std::uint32_t kNoReceiver = ~0u;

/// Those of the scene, then the back sides of those on surfaces that scatter on both sides, where they are
/// needed.
struct TransportReceivers {
    Receivers receivers;
    std::vector<std::uint32_t> back; ///< [fronts] index of the back side, kNoReceiver where none is; or empty
    std::size_t fronts = 0;

    std::uint32_t back_of(std::uint32_t front) const { return back.empty() ? kNoReceiver : back[front]; }
};

/// Adds back sides to `fronts` where `surfaces` scatter on both sides.
TransportReceivers with_back_sides(Receivers fronts, const Surfaces& surfaces);
TransportReceivers without_back_sides(Receivers fronts);

inline std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces,
                                                  const TransportReceivers& receivers) {
    return alike_receivers(surfaces, receivers.receivers, receivers.fronts, receivers.back);
}

} // namespace prt
