#pragma once

// Rays that serve direct light and bounces.

#include "lamps/lamp_rows.h"
#include "plan.h"
#include "prt/tracer.h"
#include "transport/gather.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace prt {

/// One ray of so many is followed for the bounces. Measured on the room with columns, 3 bounces, 1 024 rays:
/// relative L2 2.32 % in 1.53 s and 190 MB with every ray, 2.86 % in 1.04 s and 59 MB with every fourth (0.74
/// s without bounces); more rays would buy that error back in the time that was saved.
inline constexpr int kHitStride = 4;

/// Receivers by their number of rays.
using ByRays = std::map<std::uint32_t, std::vector<std::uint32_t>>;

/// For rays that serve both.
TraceOptions gather_options(const BakePlan& plan, std::uint32_t rays);

/// Asks whether the rows of `copies` times so many receivers fit: by what there can be at most, else by what
/// some of them see. Returns how many rays were traced. Throws `Error` where they do not fit.
std::size_t check_gather_memory(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                                const ByRays& by_rays, double copies, const std::stop_token& stop);

struct HalfOfRays;

struct TracedGather {
    GatherOperator gather;
    std::optional<LampRows> lamps; ///< where they are asked for
    std::size_t rays;              ///< traced
};

/// Traces rays_of[p] rays of every receiver p on a surface into rows of the gather operator, which keeps
/// references to `plan`. The direct transfer in `transfer` is replaced by that of the same rays: then light
/// is neither lost nor won between the two. `lamps`: makes rows for the light of lamps; may be null. `half`:
/// takes what half of the rays tell; may be null. Throws `Error` where the rows do not fit into memory.
TracedGather trace_gather(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                          std::span<const std::uint32_t> rays_of, Transfer& transfer, HalfOfRays* half,
                          const Progress& progress);

} // namespace prt
