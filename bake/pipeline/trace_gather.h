#pragma once

// Traces rays for direct light and bounces together.

#include "bake/pipeline/lamp_rows.h"
#include "bake/plan/plan.h"
#include "bake/trace/gather.h"
#include "bake/trace/tracer.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace prt {

/// One of kHitStride rays is followed for the bounces. Measured on the room with columns, 3 bounces, 1 024
/// rays: relative L2 2.32 % in 1.53 s and 190 MB with every ray, 2.86 % in 1.04 s and 59 MB with every fourth
/// (0.74 s without bounces). More rays compensate for that error in the saved time.
inline constexpr int kHitStride = 4;

/// Receivers grouped by their number of rays.
using ByRays = std::map<std::uint32_t, std::vector<std::uint32_t>>;

/// Options of rays that serve direct light and bounces.
TraceOptions gather_options(const BakePlan& plan, std::uint32_t rays);

/// Checks whether `copies` gather operators with the rows of `by_rays` fit into memory: by an upper bound, or
/// else by an estimate from rays of some receivers. Returns the number of traced rays. Throws `Error` if the
/// operators do not fit.
std::size_t check_gather_memory(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                                const ByRays& by_rays, double copies, const std::stop_token& stop);

struct HalfOfRays;

struct TracedGather {
    GatherOperator gather;
    std::optional<LampRows> lamps; ///< set if requested
    std::size_t rays;              ///< all traced rays
};

/// Traces rays_of[p] rays of every receiver p on a surface into rows of the gather operator, which keeps
/// references to `plan`. The direct transfer in `transfer` is replaced by that of the same rays, so that no
/// light is lost or counted twice between the two. `lamps`: creates rows for the light of lamps; may be null.
/// `half`: receives light from half of the rays; may be null. Throws `Error` if the rows do not fit into
/// memory.
TracedGather trace_gather(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                          std::span<const std::uint32_t> rays_of, Transfer& transfer, HalfOfRays* half,
                          const Progress& progress);

} // namespace prt
