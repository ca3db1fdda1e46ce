#pragma once

// Finer meshes where light needs them. Experimental.

#include "prt/bake.h"
#include "prt/refinement.h"

#include <cstddef>

namespace prt {

struct RefineOptions {
    double target = 0.02; ///< relative L2 of direct light over the surface, of interpolation alone
    /// Of the finer scene; 0: four times those of the scene, and 20 000 at least.
    std::size_t most_vertices = 0;
};

/// Why a refinement ended.
enum class RefineEnd {
    target,   ///< it is reached
    vertices, ///< more would be more than are allowed
    edges,    ///< what is left of the error is in triangles whose edges are too short to split
};

struct RefineStatistics {
    RefineEnd end = RefineEnd::target;
    int rounds = 0; ///< of splitting
    struct Size {
        std::size_t vertices = 0, triangles = 0;
        double error = 0; ///< relative L2 over the surface, of interpolation alone
    };
    Size before, after;
    int rays_per_point = 0;
    std::size_t points = 0, rays = 0; ///< asked and traced in all
    double seconds = 0;
};

struct RefineResult {
    Refinement refinement;
    RefineStatistics statistics;
};

/// Finds where triangles of `scene` must be split so that direct light, fitted to vertices and interpolated
/// over triangles, comes as near to light at points between them as is asked. Points have rays of their own;
/// what is traced is kept from round to round, at order 6 some 2.4 kB for each vertex. `options` are those of
/// the bake that follows. Deterministic as `bake` is. Throws `Error` for options outside their range or that
/// ask for another measure of light, `Cancelled` when asked to stop.
RefineResult refine(const Scene& scene, const BakeOptions& options, const RefineOptions& how,
                    const Progress& progress = {});

} // namespace prt
