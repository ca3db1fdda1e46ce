#pragma once

// Rays where they are needed.

#include "mesh_neighbours.h"
#include "prt/bake.h"

namespace prt {

struct AdaptiveResult {
    Transfer transfer;               ///< of the receivers on surfaces
    std::vector<std::uint32_t> rays; ///< [receivers]
    double error = 0;                ///< estimated relative L2 of the transfer
    bool reached = false;            ///< the target
};

/// Direct transfer with a relative L2 error of `target`. Every receiver is sampled with two independent
/// scrambles, whose difference estimates its error; the sequences of those that contribute most error per ray
/// are doubled until the sum is below the target (docs/math.md, section 5).
AdaptiveResult adaptive_transfer(Tracer& tracer, const Receivers& receivers, const MeshNeighbours& neighbours,
                                 const TraceOptions& options, double target, const Progress& progress);

/// Estimated relative L2 error of `transfer`, which was sampled with `options`: some of its receivers are
/// sampled again, independently.
double sampling_error(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                      const Transfer& transfer, std::size_t& rays, const Progress& progress = {});

} // namespace prt
