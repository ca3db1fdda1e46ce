#pragma once

// Ambient occlusion, obscurance and bent normals, computed from transfer of order 2, at vertices and in
// textures; occlusion volumes of moving objects. Experimental.

#include "prt/bake/bake.h"
#include "prt/bake/texels.h"
#include "prt/core/occlusion_volume.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Settings of `ambient_occlusion` and `occlusion_maps`.
struct OcclusionOptions {
    int rays = 1024; ///< number of rays per receiver, 1..kMaxRays
    /// Target relative L2 error of the transfer, finite and greater than 0. `ambient_occlusion` then chooses
    /// the number of rays of each receiver instead of `rays`. No value: each receiver gets `rays` rays.
    /// `occlusion_maps` always uses `rays`, but throws `Error` for an invalid value.
    std::optional<double> target_error;
    /// Points where `ambient_occlusion` measures visibility: vertices, or points between vertices.
    /// `occlusion_maps` always measures in texels.
    FitMode fit = FitMode::automatic;
    TracerChoice tracer; ///< hardware and method that trace the rays, and the distance fall-off of occlusion
    /// Treatment of bad textures, of receivers inside geometry, and of noise. `occlusion_maps` does not
    /// filter noise.
    Repairs repairs;
    BakeMemory memory;      ///< memory limit; BakeMemory::storage is ignored
    int threads = 0;        ///< number of threads; 0: all
    std::uint64_t seed = 0; ///< seed of the random directions of rays
};

/// Ambient visibility and bent normals. The arrays are parallel, with one entry per receiver.
struct AmbientVisibility {
    /// [receivers] share of a uniform sky's light that arrives, weighted by the cosine, 0..1; 1: all
    /// directions above the surface are unoccluded.
    std::vector<float> ambient;
    /// [receivers] unit vectors in the axes of the scene: mean unoccluded direction, weighted by the cosine.
    std::vector<glm::vec3> bent_normals;
};

/// Computes ambient visibility and bent normals of all receivers of `transfer`, which must have order 2 and a
/// single term with one channel. A receiver without light, or whose light has no mean direction, gets its
/// entry of `normals` [receivers] as bent normal, or +Y if `normals` is empty. Does not check the arguments.
AmbientVisibility ambient_visibility_of(const Transfer& transfer, std::span<const glm::vec3> normals = {});

/// Result of `ambient_occlusion`.
struct OcclusionResult {
    AmbientVisibility ambient_visibility; ///< [receivers] receivers are the vertices of the scene
    BakeStatistics statistics;            ///< measurements of the bake of order 2
};

/// Computes ambient visibility and bent normals at every vertex of `scene`, without bounces and lamps. A
/// vertex that no light reaches gets its own normal as bent normal. `finer`: as
/// for `bake`. Throws the errors of `bake`.
OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress = {}, const FinerModel& finer = {});

/// Settings of `bake_occluder` and `floor_occlusion`.
struct OccluderOptions {
    int rays = 256; ///< number of rays from each point, 1..kMaxRays; rounded up to a multiple of 6
    /// Distance by which the box of the volume extends beyond the object on every side, relative to the mean
    /// of the object's three side lengths; greater than 0.
    double margin = 0.6;
    /// Minimum effect, greater than 0: renderers ignore the object beyond the distance at which it blocks
    /// less than this fraction of the light of a receiver that faces it (OcclusionVolume::reach). The
    /// distance is an estimate, and at least half the diagonal of the box.
    double least = 0.01;
    /// Hardware that traces the rays. BakeMethod::raster and a fall-off have no effect.
    TracerChoice tracer = {};
    Repairs repairs = {};   ///< treatment of bad textures; other members have no effect
    int threads = 0;        ///< number of threads; 0: all
    std::uint64_t seed = 0; ///< seed of random points, normals and rays
};

/// Result of `bake_occluder`.
struct OccluderBake {
    OcclusionVolume volume; ///< volume in the frame of the object
    std::size_t rays = 0;   ///< number of all points, of the fit and of the test, times OccluderOptions::rays
    /// Mean absolute error of the blocked fraction of a uniform sky's light, 0..1, by the volume against
    /// rays, over test receivers. Test receivers have random normals and random positions in the box outside
    /// the object; the fit of the volume does not use these positions.
    double mean_error = 0;
    /// Mean blocked fraction of a uniform sky's light at the test receivers, by rays, 0..1. A volume that
    /// blocks nothing would have this value as its `mean_error`.
    double mean_blocked = 0;
};

/// Bakes the occlusion volume of the object that consists of all triangles of `part`. `frame` maps the
/// object's frame to the frame of the positions of `part`; it rotates, translates and scales uniformly.
/// Throws the errors of `bake`, and `Error` if `frame` is singular or not finite, if the object has a size of
/// 0, if all points around the object are inside geometry, and for a margin or minimum effect that is not
/// greater than 0.
OccluderBake bake_occluder(const Scene& part, const glm::dmat4& frame, const OccluderOptions& options = {},
                           const Progress& progress = {});

/// Occlusion of receivers that face up, on a plane directly below the bounding box of a scene. The plane
/// extends beyond the box on every side by the height of the scene.
struct FloorOcclusion {
    double mean_blocked = 0; ///< mean blocked fraction of the light of a uniform sky, by rays, 0..1
    /// Absolute difference between the blocked fractions by the volumes and by rays, 0..1: mean and maximum
    /// over the receivers.
    double mean_error = 0, largest_error = 0;
};

/// Compares the joint occlusion of all `volumes` with rays against all triangles of `scene`, at 2048 random
/// receivers. `frames` [volumes]: maps the frame of each volume to the frame of the positions of `scene`.
/// OccluderOptions::margin and OccluderOptions::least are ignored. Receivers inside geometry do not count.
/// Throws the errors of `bake`.
FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options = {},
                               const Progress& progress = {});

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
