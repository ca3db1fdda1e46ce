#pragma once

// The baker for texels: lightmaps that can be relit. Experimental.

#include "prt/bake.h"
#include "prt/lightmap.h"
#include "prt/occlusion_maps.h"

#include <cstddef>
#include <string>
#include <vector>

namespace prt {

/// Measurements of a lightmap bake.
struct LightmapStatistics {
    struct Texels {
        std::size_t all = 0;       ///< texels of all maps
        std::size_t receivers = 0; ///< texels that charts touch, and their neighbours
        std::size_t measured = 0;  ///< texels that charts touch
        std::size_t sealed = 0;    ///< measured texels inside geometry; they take the light of neighbouring
                                   ///< texels
    };
    Texels texels;
    /// Number of vertices that reflect light: vertices of the scene, and vertices added between them.
    std::size_t sources = 0;
    std::size_t rays = 0; ///< all traced rays
    std::string device;
    struct Seconds {
        double sources = 0, texels = 0, all = 0;
    };
    Seconds seconds;
    double mean_visibility = 0; ///< area-weighted mean of T_0 / Y_00 of the direct light
    /// Estimated relative L2 error: with the noise filter of a sky's light, else of direct light.
    double sampling_error = 0;
    bool denoised = false;
    double rounding_error = 0;        ///< relative L2 error of storing float16
    double seam_before = 0, seam = 0; ///< jumps of T_0 / Y_00 across seams before and after the seams were
                                      ///< closed, root mean square
    std::vector<std::string> notices;

    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

/// Result of a lightmap bake.
struct LightmapBake {
    BakedLightmap lightmap;
    LightmapStatistics statistics;
};

/// Bakes transfer of the texels of `atlases` (from plan_atlases or from an unwrapping), which contain every
/// primitive once. The value of a texel is the mean over its part of the surface, with at most options.rays
/// rays. Light bounces between vertices, and from there to the texels; options.fit applies to these vertices.
/// For this, edges longer than eight texels are split. A finer model blocks and reflects light instead of the
/// scene. Throws the errors of `bake`, and `Error` for surfaces that transmit light or contain a medium,
/// which only vertices support.
LightmapBake bake_lightmap(const Scene& scene, const std::vector<Atlas>& atlases, const BakeOptions& options,
                           const FinerModel& finer = {}, const Progress& progress = {});

/// Returns points on the UV seams of `scene`, at least two per texel along each seam, whose jumps the
/// compressor minimises. `texels`: receivers of the lightmap. A baked lightmap has almost no jumps.
std::vector<SeamJump> seam_jumps(const Scene& scene, const LightmapLayout& layout,
                                 std::span<const std::uint32_t> texels);

} // namespace prt
