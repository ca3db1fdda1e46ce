#pragma once

// How far a bake is from the light between its vertices. Experimental.

#include "prt/support/progress.h"
#include "prt/surface_points.h"
#include "prt/trace_scene.h"
#include "prt/transfer.h"

#include <cstdint>

namespace prt {

struct SurfaceReferenceOptions {
    int order = 6;
    std::size_t points = 2048; ///< about so many, by area
    int rays = 16384;          ///< from each
    std::uint64_t seed = 0x2545f4914f6cdd1d;
};

/// Direct transfer at points spread over all surfaces of a scene, by rays of their own. Points inside of
/// geometry do not count.
class SurfaceReference {
public:
    SurfaceReference(const TraceScene& scene, const SurfaceReferenceOptions& options,
                     const Progress& progress = {});

    /// Relative L2 of `direct` transfer of the scene's receivers, of one channel, interpolated.
    double relative_l2(const Transfer& direct) const;
    std::size_t points() const { return points_.size(); }

private:
    SurfacePoints points_;
    Transfer light_; ///< [points]
};

} // namespace prt
