#pragma once

// Receivers on both sides of surfaces.

#include "bake/scene/alike_receivers.h"
#include "bake/scene/detailed_surface.h"
#include "bake/scene/receivers.h"
#include "bake/scene/surfaces.h"

#include <cstdint>
#include <vector>

namespace prt {

inline constexpr std::uint32_t kNoReceiver = ~0u;

/// Receivers of the scene, then their back sides on surfaces that scatter on both sides, if they are needed.
struct TransportReceivers {
    Receivers receivers;
    std::vector<std::uint32_t> back; ///< [fronts] index of the back side; kNoReceiver: none; or empty
    std::size_t fronts = 0;
    const DetailedSurface* detail = nullptr; ///< surface on which receivers and samples are measured; null:
                                             ///< their own
    Receivers moved = {};                    ///< `receivers` on `detail`, if it is set

    /// Receivers from which rays start.
    const Receivers& measured() const { return detail ? moved : receivers; }
    std::uint32_t back_of(std::uint32_t front) const { return back.empty() ? kNoReceiver : back[front]; }
};

/// Adds back sides to `fronts` on surfaces that scatter on both sides.
TransportReceivers with_back_sides(Receivers fronts, const Surfaces& surfaces);
/// Returns `fronts` without back sides.
TransportReceivers without_back_sides(Receivers fronts);
/// Measures `receivers` on a detailed surface, to which the result keeps a reference; null: on their own.
TransportReceivers measured_on(const DetailedSurface* detail, TransportReceivers receivers);

inline std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces,
                                                  const TransportReceivers& receivers) {
    return alike_receivers(surfaces, receivers.receivers, receivers.fronts, receivers.back);
}

} // namespace prt
