#pragma once

// Ambient occlusion, obscurance and bent normals, computed from transfer of order 2. Experimental.

#include "prt/bake.h"

#include <glm/vec3.hpp>

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
    /// FitMode::surface does not support BakeMethod::raster or a target error. `occlusion_maps` always
    /// measures in texels.
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
/// vertex that no light reaches gets its own normal as bent normal. Throws the errors of `bake`.
OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress = {});

} // namespace prt
