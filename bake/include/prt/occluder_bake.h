#pragma once

// Bakes the occlusion volume of a rigid object (prt/occlusion_volume.h). Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/occlusion_volume.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

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
    /// Hardware that traces the rays. BakeMethod::raster is not supported, and a fall-off has no effect.
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
/// 0, if all points around the object are inside geometry, for a margin or minimum effect that is not greater
/// than 0, and for BakeMethod::raster.
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
/// Throws the errors of `bake`, and `Error` for BakeMethod::raster.
FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options = {},
                               const Progress& progress = {});

} // namespace prt
