#pragma once

// Refinement: chooses triangles that must be split so that interpolation between vertices shows the direct
// light. Experimental.

#include "prt/bake/bake.h"
#include "prt/gltf/refinement.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Settings of the refinement.
struct RefineOptions {
    /// Target for the interpolation error of direct light: relative L2 over the whole surface, weighted by
    /// area. Finite and greater than 0.
    double target = 0.02;
    /// Maximum number of vertices of the refined scene. 0: four times the number of vertices of the original
    /// scene, or 20 000 if that is larger.
    std::size_t max_vertices = 0;
    /// Nodes of the scene whose triangles are not split, for example instances that share transfer. They cast
    /// shadows, but their error is not measured. Triangles that share edges with them can also remain whole.
    std::vector<int> kept_nodes = {};
};

/// Reason why a refinement ended.
enum class RefineEnd {
    target,   ///< the error is at most RefineOptions::target
    vertices, ///< another split would exceed the maximum number of vertices
    edges,    ///< all triangles with an error have edges that are too short to split
};

/// Measurements of a refinement. Errors are those of the surfaces that can be split.
struct RefineStatistics {
    RefineEnd end = RefineEnd::target; ///< reason why the refinement ended
    int rounds = 0; ///< number of rounds, each of which splits some triangles; 0: nothing was split
    /// Size of a scene, and its error.
    struct Size {
        std::size_t vertices = 0, ///< number of vertices of the scene
            triangles = 0;        ///< number of triangles of the scene
        double error = 0;         ///< interpolation error of direct light, relative L2 over the whole surface
    };
    Size before,            ///< original scene
        after;              ///< refined scene
    int rays_per_point = 0; ///< number of rays that measure the light at each test point
    std::size_t points = 0, ///< number of all test points, including points inside geometry
        rays = 0;           ///< number of all traced rays, including those that find points inside geometry
    double seconds = 0;     ///< duration of `refine`
};

/// Result of `refine`.
struct RefineResult {
    Refinement refinement; ///< added vertices and new triangles; pass it to `refined` (prt/gltf/refinement.h)
    RefineStatistics statistics; ///< errors before and after, sizes, and the reason for the end
};

/// Chooses triangles of `scene` to split, and returns the refinement; `scene` is not changed. Measures the
/// error of direct light on front sides, fitted to vertices and interpolated, against rays at test points on
/// the triangles. Splits triangles with the largest errors until a condition of `RefineEnd` is met. `options`
/// are those of the bake that follows; the number of rays and the bounces in them have no effect. On the CPU
/// the result is deterministic and does not depend on the number of threads. Needs about 2.4 kB of memory per
/// vertex of the refined scene at order 6. Throws `Error` if the order, the media or `how.target` are
/// invalid, and if `options` have FitMode::vertex. Light is measured by rays, also for BakeMethod::raster,
/// with BakeOptions::rays, also with a target error. Also throws the errors of `load_textures`, `make_tracer`
/// and Tracer::trace, and `Cancelled` after a stop request.
/// `finer`: as for `bake`.
RefineResult refine(const Scene& scene, const BakeOptions& options, const RefineOptions& how,
                    const Progress& progress = {}, const FinerModel& finer = {});

} // namespace prt
