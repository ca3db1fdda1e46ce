#pragma once

// The baker: transfer vectors of every receiver of a scene.

#include "prt/gltf.h"
#include "prt/progress.h"
#include "prt/tracer.h"

namespace prt {

struct BakeOptions {
    int order = 6;
    int rays = 1024; ///< per receiver
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
};

struct BakeStatistics {
    std::size_t receivers = 0; ///< all
    std::size_t traced = 0;    ///< those on a surface; the others have zero transfer
    std::size_t triangles = 0;
    double seconds_build = 0; ///< the bounding volume hierarchy
    double seconds_trace = 0; ///< everything else
    double rays_per_second = 0;
    double mean_visibility = 0; ///< area-weighted T_0 / Y_00
};

struct BakeResult {
    BakedTransfer baked;
    BakeStatistics statistics;
};

/// Bakes direct shadowed transfer for every vertex. Deterministic from the seed, whatever the number of
/// threads. Throws `Error` for options outside their range and `Cancelled`.
BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress = {});

/// Runs `tracer` over those `receivers` that have an area and a normal; the others get zeros.
Transfer direct_transfer(Tracer& tracer, const Receivers& receivers, const DirectOptions& options,
                         const Progress& progress = {});

/// Area-weighted mean of T_0 / Y_00 over all channels.
double mean_visibility(const Transfer& transfer, std::span<const float> areas);

} // namespace prt
