#pragma once

// Bakes the occlusion around an object that moves as one (prt/occlusion_volume.h). Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/occlusion_volume.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

struct OccluderOptions {
    int rays = 256; ///< rays per point from which the object is sampled
    /// Distance that the box extends beyond the object on every side, relative to the mean of the object's
    /// sides.
    double margin = 0.6;
    /// The object is ignored beyond the distance where it blocks less than this fraction of the light of a
    /// receiver that faces it.
    double least = 0.01;
    TracerChoice tracer = {};
    Repairs repairs = {};
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

struct OccluderBake {
    OcclusionVolume volume;
    std::size_t rays = 0;
    /// Mean difference between the visibility of receivers from the volume and from rays. The receivers are
    /// at random positions of the box outside the object with random normals; the fit uses other positions.
    double mean_error = 0;
    /// Mean blocked fraction of these receivers by rays, which is the error of a volume that blocks nothing.
    double mean_blocked = 0;
};

/// Bakes a volume of all triangles of `part`. `frame` maps the object's frame to the frame of the positions
/// of `part`; it rotates, translates and scales. Throws the same errors as `bake`, and an `Error` if `frame`
/// is singular.
OccluderBake bake_occluder(const Scene& part, const glm::dmat4& frame, const OccluderOptions& options = {},
                           const Progress& progress = {});

/// Occlusion of receivers that face up in the ground plane of a scene, below it and as far around it as the
/// scene is high.
struct FloorOcclusion {
    double mean_blocked = 0; ///< mean blocked fraction of their light, by rays
    double mean_error = 0, largest_error = 0;
};

/// Compares the occlusion of `volumes` in their `frames` together with rays through all of `scene`.
FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options = {},
                               const Progress& progress = {});

} // namespace prt
