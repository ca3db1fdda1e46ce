#pragma once

// The baker for texels: lightmaps that can be relit. Experimental.

#include "prt/bake/ambient_occlusion.h"
#include "prt/bake/bake.h"
#include "prt/core/lightmap.h"

#include <cstddef>
#include <string>
#include <vector>

namespace prt {

/// Measurements of a lightmap bake.
struct LightmapStatistics {
    /// Numbers of texels, summed over all maps.
    struct Texels {
        std::size_t all = 0;       ///< texels of all maps, including texels outside charts
        std::size_t receivers = 0; ///< texels with transfer: texels that charts touch, and their neighbours
        std::size_t measured = 0;  ///< texels that charts touch, from which rays were traced
        std::size_t sealed = 0;    ///< measured texels inside solid geometry, which take the light of
                                   ///< neighbouring texels; 0 with Inside::keep
    };
    Texels texels;
    /// Number of receivers between which light bounces: vertices of the scene (of the finer model, if there
    /// is one), vertices that were added between them, and back sides that scatter light; 0 without bounces.
    std::size_t sources = 0;
    std::size_t rays = 0; ///< number of all traced rays
    std::string device;   ///< name of the device that traced the rays, for reports
    /// Wall-clock time in seconds. `sources`: time until the light of the vertices is known; `texels`: time
    /// for tracing and processing texels; `all`: total time, the sum of both.
    struct Seconds {
        double sources = 0, texels = 0, all = 0;
    };
    Seconds seconds;
    /// Share of a uniform sky's light that arrives at fronts without bounces, 0..1: mean over the receivers,
    /// weighted by area, of T_0 / Y_00. T_0 is the first coefficient of direct light before it passes sheets
    /// or media, Y_00 the constant SH function.
    double mean_visibility = 0;
    /// Estimated relative L2 error of the transfer by noise of rays. If `denoised`, it applies to all light
    /// of the sky after the noise filter, otherwise to direct light of the sky.
    double sampling_error = 0;
    bool denoised = false;     ///< true: the noise filter was applied
    double rounding_error = 0; ///< relative L2 error that storing the transfer as float16 causes; computed
                               ///< for both number formats
    /// Root mean square jump of T_0 / Y_00 of direct light between the two sides of UV seams: `seam_before`
    /// before the bake closed the seams, `seam` in the result. 0 if no map has a seam.
    double seam_before = 0, seam = 0;
    std::vector<std::string> notices; ///< parts of the scene that the bake left out or repaired, with
                                      ///< reasons, and texels far from the finer model, one line each

    /// Returns all traced rays divided by the total time, per second.
    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

/// Result of a lightmap bake.
struct LightmapBake {
    BakedLightmap lightmap;
    LightmapStatistics statistics;
};

/// Bakes transfer of the texels of `atlases`, which contain every primitive of `scene` once (from
/// plan_atlases or from an unwrapping). The value of a texel is the mean over its part of the surface, with
/// up to options.rays rays (at least one for each of up to four points), plus the rays to lamps. Light
/// bounces between vertices, and from vertices to texels. options.fit applies to these vertices, and edges
/// longer than eight texels are split for them. If `finer` has a scene, that scene blocks and reflects light
/// instead of `scene`, and texels are measured on its surface as in `occlusion_maps`. Texels on sheets and
/// media of `scene` have the exit transfer that vertices there would have; for media, light arrives at
/// vertices of edges of at most two texels. Throws the errors of `bake` and `check_finer`, and `Error` if
/// `finer` has no surface near the scene.
LightmapBake bake_lightmap(const Scene& scene, const std::vector<Atlas>& atlases, const BakeOptions& options,
                           const FinerModel& finer = {}, const Progress& progress = {});

/// Returns the atlases with which a lightmap was baked.
std::vector<Atlas> atlases_of(const LightmapLayout& layout);

/// Returns points on the UV seams of `scene`, at least two per texel along each seam, whose jumps the
/// compressor minimises. `texels` [receivers]: numbers of the lightmap's texels with transfer, in ascending
/// order, as in BakedLightmap::texels. Seams between different normals, and points whose bilinear filters
/// read other texels, are omitted. A baked lightmap has almost no jumps at these points.
std::vector<SeamJump> seam_jumps(const Scene& scene, const LightmapLayout& layout,
                                 std::span<const std::uint32_t> texels);

} // namespace prt
