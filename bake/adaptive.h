#pragma once

// Rays where they are needed.

#include "prt/support/progress.h"
#include "prt/tracer.h"
#include "scene/mesh_neighbours.h"

namespace prt {

struct AdaptiveResult {
    Transfer transfer;               ///< of the receivers on surfaces
    Transfer half;                   ///< by the first half of the rays of each
    std::vector<std::uint32_t> rays; ///< [receivers]
    std::size_t rays_checked = 0;    ///< traced beside them, to estimate errors
    double error = 0;                ///< estimated relative L2 of the transfer
    bool reached = false;            ///< the target
};

/// Direct transfer with a relative L2 error of `target`. Two independent scrambles of a few rays estimate the
/// error of every receiver; from that the number of rays of each is planned, so that together they cost
/// least; a sample of the receivers, traced again, tells what came out, and if it is not enough the plan is
/// extended (docs/math.md, section 9). `left` [receivers]: factor that later means over receivers apply to
/// the squared error of each; the target includes it.
AdaptiveResult adaptive_transfer(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                                 std::span<const float> left, const TraceOptions& options, double target,
                                 const Progress& progress);

} // namespace prt
