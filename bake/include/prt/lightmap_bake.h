#pragma once

// The baker at texels: lightmaps that are relit. Experimental.

#include "prt/bake.h"
#include "prt/lightmap.h"
#include "prt/occlusion_maps.h"

#include <cstddef>
#include <string>
#include <vector>

namespace prt {

struct LightmapStatistics {
    struct Texels {
        std::size_t all = 0;       ///< of the maps
        std::size_t receivers = 0; ///< those that charts touch, and those beside them
        std::size_t measured = 0;  ///< those that charts touch
        std::size_t sealed = 0;    ///< of these, inside geometry: they take the light of texels beside them
    };
    Texels texels;
    std::size_t sources = 0; ///< vertices that bounced light comes from, of the scene and between
    std::size_t rays = 0;    ///< traced in all
    std::string device;
    struct Seconds {
        double sources = 0, texels = 0, all = 0;
    };
    Seconds seconds;
    double mean_visibility = 0; ///< area-weighted T_0 / Y_00 of the direct light
    /// Estimated relative L2: of the filtered light of a sky, or of direct light at places of texels.
    double sampling_error = 0;
    bool denoised = false;
    double rounding_error = 0;        ///< relative L2 of storing float16
    double seam_before = 0, seam = 0; ///< jumps of T_0 / Y_00 across seams, root mean square
    std::vector<std::string> notices;

    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

struct LightmapBake {
    BakedLightmap lightmap;
    LightmapStatistics statistics;
};

/// Bakes transfer of the texels of `atlases` (plan_atlases, or those of an unwrapping), which hold every
/// primitive once. A texel has the mean over its part of the surface, with options.rays at most. Light
/// bounces between vertices, with others between them where these are further apart than texels are fine, and
/// from there to the texels; options.fit is of those vertices. A finer model casts and bounces light in the
/// place of the scene. Throws as `bake` does, and for surfaces that light passes through or into, which are
/// known at vertices alone.
LightmapBake bake_lightmap(const Scene& scene, const std::vector<Atlas>& atlases, const BakeOptions& options,
                           const FinerModel& finer = {}, const Progress& progress = {});

/// For the compressor: jumps across the seams of the lightmap of `scene` with receivers `texels`, two a texel
/// along each at least. What was baked has next to none.
std::vector<SeamJump> seam_jumps(const Scene& scene, const LightmapLayout& layout,
                                 std::span<const std::uint32_t> texels);

} // namespace prt
