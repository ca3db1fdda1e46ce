#pragma once

// Traces direct transfer with a number of rays that adapts to each receiver.

#include "bake/scene/mesh_neighbours.h"
#include "bake/trace/tracer.h"
#include "prt/core/progress.h"

namespace prt {

struct AdaptiveResult {
    Transfer transfer;               ///< transfer of the receivers on surfaces
    Transfer half;                   ///< transfer from the first half of each receiver's rays
    std::vector<std::uint32_t> rays; ///< [receivers] number of rays
    std::size_t rays_checked = 0;    ///< additional rays that estimated errors
    double error = 0;                ///< estimated relative L2 error of the transfer
    bool reached = false;            ///< the target was reached
};

/// Computes direct transfer with a relative L2 error of `target`. Two independent scrambles with few rays
/// estimate the error of every receiver, and the number of rays per receiver is planned to minimise the total
/// cost. A sample of the receivers, traced again, measures the error that was reached; if it is too large,
/// the plan is extended (docs/math.md, section 9). `left` [receivers]: factor that later means over receivers
/// apply to the squared error of each; the target includes it.
AdaptiveResult adaptive_transfer(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                                 std::span<const float> left, const TraceOptions& options, double target,
                                 const Progress& progress);

} // namespace prt
