#pragma once

// Refines meshes where the light requires it. Experimental.

#include "prt/bake.h"
#include "prt/refinement.h"

#include <cstddef>

namespace prt {

/// Settings of the refinement.
struct RefineOptions {
    /// Target for the interpolation error of direct light over the surface, relative L2.
    double target = 0.02;
    /// Maximum number of vertices of the finer scene; 0: four times the number in the scene, but at least
    /// 20000.
    std::size_t max_vertices = 0;
};

/// Reason why a refinement ended.
enum class RefineEnd {
    target,   ///< the target is reached
    vertices, ///< the maximum number of vertices is reached
    edges,    ///< the remaining error is in triangles with edges that are too short to split
};

/// Measurements of a refinement.
struct RefineStatistics {
    RefineEnd end = RefineEnd::target;
    int rounds = 0; ///< rounds of splitting
    struct Size {
        std::size_t vertices = 0, triangles = 0;
        double error = 0; ///< interpolation error over the surface, relative L2
    };
    Size before, after;
    int rays_per_point = 0;
    std::size_t points = 0, rays = 0; ///< all test points, and all traced rays
    double seconds = 0;
};

/// Result of `refine`.
struct RefineResult {
    Refinement refinement;
    RefineStatistics statistics;
};

/// Chooses triangles of `scene` to split. Direct light is fitted to vertices, interpolated over triangles,
/// and compared with light at test points between the vertices, which is traced with separate rays. Traced
/// light is kept between rounds, which takes about 2.4 kB per vertex at order 6. `options` are those of the
/// bake that follows. Deterministic in the same way as `bake`. Throws `Error` for options that are invalid or
/// not supported by refinement, and `Cancelled` after a stop request.
RefineResult refine(const Scene& scene, const BakeOptions& options, const RefineOptions& how,
                    const Progress& progress = {});

} // namespace prt
