#pragma once

// Measures the error of direct transfer at vertices, against rays at points between the vertices.
// Experimental.

#include "bake/reference/surface_points.h"
#include "bake/scene/trace_scene.h"
#include "prt/core/progress.h"
#include "prt/core/transfer.h"

#include <cstdint>

namespace prt {

/// Settings of `SurfaceReference`.
struct SurfaceReferenceOptions {
    int order = 6;                           ///< order of the transfer that is measured
    std::size_t points = 2048;               ///< approximate number of points, spread evenly by area
    int rays = 16384;                        ///< number of rays per point, at least 1
    std::uint64_t seed = 0x2545f4914f6cdd1d; ///< seed of points and rays; must differ from that of the bake
};

/// Direct transfer at points that are spread evenly by area over the front sides of all surfaces of a scene,
/// traced with rays that are independent of a bake. The same points are excluded as by `surface_points`.
class SurfaceReference {
public:
    /// Chooses the points and traces their transfer on the CPU. Keeps no reference to `scene`. Throws the
    /// errors of TraceScene::rays, and `Cancelled` after a stop request.
    SurfaceReference(const TraceScene& scene, const SurfaceReferenceOptions& options,
                     const Progress& progress = {});

    /// Returns the relative L2 error of `direct` at the points, weighted by area, after interpolation between
    /// vertices; 0 without an error, infinity if `direct` has light at the points but the reference has none.
    /// `direct` is the direct transfer of the scene's receivers: one term with one channel, of order
    /// SurfaceReferenceOptions::order.
    double relative_l2(const Transfer& direct) const;
    /// Returns the number of points, without excluded points.
    std::size_t points() const { return points_.size(); }

private:
    SurfacePoints points_;
    Transfer light_; ///< transfer of the points: [points][order²]
};

} // namespace prt
