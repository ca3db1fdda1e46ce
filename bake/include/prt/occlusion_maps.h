#pragma once

// Ambient occlusion in textures. Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/texels.h"

#include <functional>
#include <string>
#include <vector>

namespace prt {

/// Occlusion of one texture, row by row from the top.
struct OcclusionMap {
    Atlas atlas;
    /// [texels]; texels between charts take the values of their neighbours.
    AmbientVisibility ambient_visibility;
    std::size_t measured = 0;         ///< texels on surfaces
    std::size_t sealed = 0;           ///< measured texels inside geometry; they take the values of their
                                      ///< neighbours
    double seam_before = 0, seam = 0; ///< jumps of `ambient` across seams before and after the seams were
                                      ///< closed, root mean square
};

/// Measurements of `occlusion_maps`.
struct OcclusionMapsStatistics {
    std::size_t rays = 0;
    std::string device;
    double seconds = 0;
    std::vector<std::string> notices;
};

/// A high-poly model that blocks and reflects light instead of the scene.
struct FinerModel {
    const Scene* scene = nullptr; ///< null: the scene itself blocks light
    double reach = 0;             ///< maximum distance between the finer surface and the scene's surface,
                                  ///< metres
};

/// Throws `Error` if the distance of a finer model is invalid.
void check_finer(const FinerModel& finer);

/// Computes the maps of `atlases` (from plan_atlases or from an unwrapping) and passes them to `take` one
/// after the other. The value of a texel is the mean over its part of the surface, with at most options.rays
/// rays. If the finer model has a surface above or below the texel, the value is measured there. Throws the
/// same errors as `bake`.
OcclusionMapsStatistics occlusion_maps(const Scene& scene, const std::vector<Atlas>& atlases,
                                       const OcclusionOptions& options,
                                       const std::function<void(OcclusionMap)>& take,
                                       const FinerModel& finer = {}, const Progress& progress = {});

} // namespace prt
