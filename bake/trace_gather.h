#pragma once

// Rays that serve direct light and bounces.

#include "plan.h"
#include "prt/tracer.h"
#include "transport/gather.h"

namespace prt {

struct TracedGather {
    GatherOperator gather;
    std::size_t rays; ///< traced
};

/// Traces rays_of[p] rays of every receiver p on a surface into rows of the gather operator, which keeps
/// references to `plan`. The direct transfer in `transfer` is replaced by that of the same rays: then light
/// is neither lost nor won between the two. Throws `Error` where the rows do not fit into memory.
TracedGather trace_gather(const BakePlan& plan, Tracer& tracer, std::span<const std::uint32_t> rays_of,
                          Transfer& transfer, const Progress& progress);

} // namespace prt
