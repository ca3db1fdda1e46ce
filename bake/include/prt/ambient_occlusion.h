#pragma once

// Ambient occlusion, obscurance and bent normals, computed from transfer of order 2. Experimental.

#include "prt/bake.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Settings of `ambient_occlusion` and `occlusion_maps`.
struct OcclusionOptions {
    int rays = 1024;                    ///< rays per receiver
    std::optional<double> target_error; ///< see BakeOptions::target_error
    /// Points where visibility is measured: vertices, or points between them.
    FitMode fit = FitMode::automatic;
    TracerChoice tracer; ///< tracer, including its distance fall-off
    Repairs repairs;
    BakeMemory memory;
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Ambient visibility and bent normals, one entry per receiver.
struct AmbientVisibility {
    std::vector<float> ambient;          ///< cosine-weighted visible share of a uniform sky, 0..1
    std::vector<glm::vec3> bent_normals; ///< unit; mean unoccluded direction, weighted by the cosine
};

/// Computes ambient visibility and bent normals from transfer of order 2 with one channel. A receiver that no
/// light reaches gets its entry of `normals` [receivers] as bent normal, or +Y if `normals` is empty.
AmbientVisibility ambient_visibility_of(const Transfer& transfer, std::span<const glm::vec3> normals = {});

/// Result of `ambient_occlusion`.
struct OcclusionResult {
    AmbientVisibility ambient_visibility; ///< [receivers]
    BakeStatistics statistics;
};

/// Computes ambient occlusion of every vertex of `scene`. Throws the same errors as `bake`.
OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress = {});

} // namespace prt
