#pragma once

// Refines meshes where the light requires it. Experimental.

#include "prt/bake.h"
#include "prt/refinement.h"

#include <cstddef>

namespace prt {

struct RefineOptions {
    double target = 0.02; ///< target relative L2 error of direct light over the surface, by interpolation
                          ///< only
    /// Maximum number of vertices of the finer scene; 0: four times the number in the scene, but at least 20
    /// 000.
    std::size_t max_vertices = 0;
};

/// Reason why a refinement ended.
enum class RefineEnd {
    target,   ///< the target is reached
    vertices, ///< the maximum number of vertices is reached
    edges,    ///< the remaining error is in triangles whose edges are too short to split
};

struct RefineStatistics {
    RefineEnd end = RefineEnd::target;
    int rounds = 0; ///< rounds of splitting
    struct Size {
        std::size_t vertices = 0, triangles = 0;
        double error = 0; ///< relative L2 error over the surface, by interpolation only
    };
    Size before, after;
    int rays_per_point = 0;
    std::size_t points = 0, rays = 0; ///< all test points, and all traced rays
    double seconds = 0;
};

struct RefineResult {
    Refinement refinement;
    RefineStatistics statistics;
};

/// Finds triangles of `scene` to split, so that direct light that is fitted to vertices and interpolated over
/// triangles matches the light at test points between the vertices. Points have their own rays. Traced light
/// is kept from round to round, about 2.4 kB per vertex at order 6. `options` are those of the bake that
/// follows. Deterministic in the same way as `bake`. Throws `Error` for options that are invalid or that
/// require another measure of light, and `Cancelled` when asked to stop.
RefineResult refine(const Scene& scene, const BakeOptions& options, const RefineOptions& how,
                    const Progress& progress = {});

} // namespace prt
