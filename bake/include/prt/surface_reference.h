#pragma once

// Measures the error of a bake against the light between its vertices. Experimental.

#include "prt/support/progress.h"
#include "prt/surface_points.h"
#include "prt/trace_scene.h"
#include "prt/transfer.h"

#include <cstdint>

namespace prt {

/// Settings of `SurfaceReference`.
struct SurfaceReferenceOptions {
    int order = 6;
    std::size_t points = 2048; ///< approximate number of points, spread by area
    int rays = 16384;          ///< rays per point
    std::uint64_t seed = 0x2545f4914f6cdd1d;
};

/// Direct transfer at points that are spread over all surfaces of a scene, traced with separate rays. Points
/// inside geometry are excluded.
class SurfaceReference {
public:
    SurfaceReference(const TraceScene& scene, const SurfaceReferenceOptions& options,
                     const Progress& progress = {});

    /// Returns the relative L2 error of `direct`, transfer of the scene's receivers with one channel,
    /// interpolated to the points.
    double relative_l2(const Transfer& direct) const;
    std::size_t points() const { return points_.size(); }

private:
    SurfacePoints points_;
    Transfer light_; ///< [points]
};

} // namespace prt
