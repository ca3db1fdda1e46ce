#pragma once

// Bakes what an object that moves as one blocks around it (prt/occlusion_volume.h). Experimental.

#include "prt/ambient_occlusion.h"
#include "prt/occlusion_volume.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

struct OccluderOptions {
    int rays = 256; ///< of a point where the object is looked at
    /// How far the box goes beyond the object on every side, over the mean of its sides.
    double margin = 0.6;
    /// The object is left out from where it takes less than this of the light of a receiver that faces it.
    double least = 0.01;
    TracerChoice tracer = {};
    Repairs repairs = {};
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
};

struct OccluderBake {
    OcclusionVolume volume;
    std::size_t rays = 0;
    /// Mean difference of the openness of receivers at random places of the box outside of the object, facing
    /// anywhere, to that by rays; of others than those that the volume is made of.
    double mean_error = 0;
    /// That of a volume that blocks nothing: how much there is to block.
    double mean_blocked = 0;
};

/// Of all triangles of `part`. `frame` takes the object's frame to where positions of `part` are seen from;
/// it turns, moves and scales. Throws `Error` as `bake` does, and where `frame` is singular.
OccluderBake bake_occluder(const Scene& part, const glm::dmat4& frame, const OccluderOptions& options = {},
                           const Progress& progress = {});

/// Receivers that face up in the plane that a scene stands on, below it and as far around as it is high.
struct FloorOcclusion {
    double mean_blocked = 0; ///< of their light, by rays
    double mean_error = 0, largest_error = 0;
};

/// What `volumes` in their `frames` block there together, against rays through all of `scene`.
FloorOcclusion floor_occlusion(const Scene& scene, std::span<const OcclusionVolume> volumes,
                               std::span<const glm::dmat4> frames, const OccluderOptions& options = {},
                               const Progress& progress = {});

} // namespace prt
