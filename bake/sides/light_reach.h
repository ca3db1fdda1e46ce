#pragma once

// Which sides of surfaces any light reaches.

#include "lamps/choose_lamps.h"
#include "prt/trace_scene.h"
#include "scene/ray_starts.h"

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace prt {

/// Mean reach over a piece of surface, above what comes through the cracks of solids.
inline constexpr double kLeastReach = 1e-3;

struct ReachOptions {
    std::span<const Lamp> lamps = {}; ///< those that are lit
    std::uint64_t seed = 0;
};

/// Mean over a few paths from that side of each of `triangles` of 1/2 for each surface that
/// they meet before they end in the sky above the horizon, or where a point of a lamp that is drawn by chance
/// is in sight; 0 of those that do not get there in eight bounces. An order of magnitude, and 0 where no
/// light gets in. Throws `Cancelled` when asked to stop.
std::vector<float> light_reach(const TraceScene& scene, std::span<const std::uint32_t> triangles, Side side,
                               const ReachOptions& options, const std::stop_token& stop);

} // namespace prt
