#pragma once

// Ambient occlusion in textures. Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/texels.h"

#include <string>
#include <vector>

namespace prt {

/// Of one texture, row by row from the top.
struct OcclusionMap {
    Atlas atlas;
    Openness openness;                ///< [texels]; between charts that of texels beside them
    std::size_t measured = 0;         ///< texels that lie on surfaces
    std::size_t sealed = 0;           ///< of those: inside geometry, as between charts
    double seam_before = 0, seam = 0; ///< the largest jump of `ambient` across seams, before and after
};

struct OcclusionMapsResult {
    std::vector<OcclusionMap> maps;
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

/// Of the textures of `atlases` (plan_atlases): a texel has the mean over its part of the surface, with
/// options.rays in all. Where a finer model has a surface over or under it, a texel has what arrives there.
/// Throws as `bake` does.
OcclusionMapsResult occlusion_maps(const Scene& scene, const std::vector<Atlas>& atlases,
                                   const OcclusionOptions& options, const FinerModel& finer = {},
                                   const Progress& progress = {});

} // namespace prt
