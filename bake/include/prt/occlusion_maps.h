#pragma once

// Ambient occlusion in textures. Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/texels.h"

#include <functional>
#include <string>
#include <vector>

namespace prt {

/// Of one texture, row by row from the top.
struct OcclusionMap {
    Atlas atlas;
    Openness openness;                ///< [texels]; between charts that of texels beside them
    std::size_t measured = 0;         ///< texels that lie on surfaces
    std::size_t sealed = 0;           ///< of those: inside geometry, as between charts
    double seam_before = 0, seam = 0; ///< jumps of `ambient` across seams, root mean square, before and after
};

struct OcclusionMapsStatistics {
    std::size_t rays = 0;
    std::string device;
    double seconds = 0;
    std::vector<std::string> notices;
};

/// A finer model that casts in the place of the scene.
struct FinerModel {
    const Scene* scene = nullptr; ///< null: the scene casts itself
    double reach = 0;             ///< metres, that its surface may lie off that of the scene
};

/// Throws `Error` where a finer model lies off by no length.
void check_finer(const FinerModel& finer);

/// Gives `take` the maps of `atlases` (plan_atlases, or those of an unwrapping), one after the other: a texel
/// has the mean over its part of the surface, with options.rays at most. Where a finer model has a surface
/// over or under it, it has what arrives there. Throws as `bake` does.
OcclusionMapsStatistics occlusion_maps(const Scene& scene, const std::vector<Atlas>& atlases,
                                       const OcclusionOptions& options,
                                       const std::function<void(OcclusionMap)>& take,
                                       const FinerModel& finer = {}, const Progress& progress = {});

} // namespace prt
