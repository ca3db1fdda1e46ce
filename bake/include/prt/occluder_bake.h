#pragma once

// Bakes the occlusion volume of a rigid object (prt/occlusion_volume.h). Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/occlusion_volume.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// Settings of the bake.
struct OccluderOptions {
    int rays = 256; ///< number of rays from each point around the object
    /// Distance by which the box extends beyond the object on every side, relative to the mean of the
    /// object's side lengths.
    double margin = 0.6;
    /// Minimum effect: the object is ignored beyond the distance at which it blocks less than this fraction
    /// of the light of a receiver that faces it.
    double least = 0.01;
    TracerChoice tracer = {};
    Repairs repairs = {};
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Result of the bake.
struct OccluderBake {
    OcclusionVolume volume;
    std::size_t rays = 0;
    /// Mean absolute difference between the visibility by the volume and by rays, over test receivers. These
    /// have random normals and random positions in the box outside the object, which the fit does not use.
    double mean_error = 0;
    /// Mean blocked fraction of the test receivers by rays: the error of a volume that blocks nothing.
    double mean_blocked = 0;
};

/// Bakes the occlusion volume of all triangles of `part`. `frame` maps the object's frame to the frame of the
/// positions of `part`; it rotates, translates and scales. Throws the errors of `bake`, and `Error` if
/// `frame` is singular.
OccluderBake bake_occluder(const Scene& part, const glm::dmat4& frame, const OccluderOptions& options = {},
                           const Progress& progress = {});

/// Occlusion on the ground below a scene, and around it up to a distance equal to its height. The receivers
/// face up.
struct FloorOcclusion {
    double mean_blocked = 0; ///< mean blocked fraction of the light, by rays
    double mean_error = 0, largest_error = 0;
};

/// Compares the joint occlusion of `volumes`, placed by `frames`, with rays against all of `scene`.
FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options = {},
                               const Progress& progress = {});

} // namespace prt
