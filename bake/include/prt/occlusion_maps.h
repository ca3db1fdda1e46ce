#pragma once

// Ambient occlusion and bent normals in textures. Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/texels.h"

#include <functional>
#include <string>
#include <vector>

namespace prt {

/// Occlusion of one texture.
struct OcclusionMap {
    Atlas atlas; ///< size of the texture, and the primitives that it covers
    /// Both arrays are [atlas.height][atlas.width], row by row from v = 0 at the top. Texels between charts
    /// take the values of their neighbours. Texels that no light reaches have the bent normal +Y.
    AmbientVisibility ambient_visibility;
    std::size_t measured = 0; ///< number of texels that charts touch, from which rays were traced
    std::size_t sealed = 0;   ///< number of measured texels inside solid geometry, which take the values of
                              ///< their neighbours; 0 with Inside::keep
    /// Root mean square jump of ambient visibility between the two sides of UV seams: `seam_before` before
    /// the seams were closed, `seam` in the result. 0 if the texture has no seam.
    double seam_before = 0, seam = 0;
};

/// Measurements of `occlusion_maps`, over all textures.
struct OcclusionMapsStatistics {
    std::size_t rays = 0;             ///< number of all traced rays
    std::string device;               ///< name of the device that traced the rays, for reports
    double seconds = 0;               ///< total wall-clock time in seconds
    std::vector<std::string> notices; ///< parts of the scene that were ignored or repaired, with reasons, and
                                      ///< texels far from the finer model, one line each
};

/// An optional high-poly model of the same object that blocks and reflects light instead of the scene.
struct FinerModel {
    const Scene* scene = nullptr; ///< the model, which the caller keeps; null: the scene itself blocks light
    double reach = 0;             ///< maximum distance in metres between the model's surface and the scene's
                                  ///< surface, along the normal of the scene's surface; if `scene` is set,
                                  ///< must be greater than 0 and at most kFarthestVertex
};

/// Throws `Error` if `finer` has a scene and its `reach` is not greater than 0 or exceeds kFarthestVertex.
void check_finer(const FinerModel& finer);

/// Computes the maps of `atlases` (from plan_atlases or from an unwrapping) and passes each to `take`, in the
/// order of `atlases`, from the calling thread. The value of a texel is the mean over its part of the
/// surface, with up to options.rays rays (at least one for each of up to four points). If `finer` has a
/// surface within reach above or below the texel that faces the same way, the value is measured on that
/// surface. Throws the errors of `bake` and `check_finer`. Throws `Error` after the last map if `finer` has
/// no surface near the scene.
OcclusionMapsStatistics occlusion_maps(const Scene& scene, const std::vector<Atlas>& atlases,
                                       const OcclusionOptions& options,
                                       const std::function<void(OcclusionMap)>& take,
                                       const FinerModel& finer = {}, const Progress& progress = {});

} // namespace prt
