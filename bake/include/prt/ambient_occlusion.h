#pragma once

// Ambient occlusion, obscurance and bent normals, computed from transfer of order 2. Experimental.

#include "prt/bake.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

struct OcclusionOptions {
    int rays = 1024;                    ///< rays per receiver
    std::optional<double> target_error; ///< see BakeOptions::target_error
    FitMode fit = FitMode::automatic;   ///< positions where visibility is measured
    TracerChoice tracer;                ///< tracer, including its distance fall-off
    Repairs repairs;
    BakeMemory memory;
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Ambient visibility and bent normals, one entry per receiver.
struct AmbientVisibility {
    std::vector<float> ambient;          ///< cosine-weighted visible share of a uniform sky, 0..1
    std::vector<glm::vec3> bent_normals; ///< unit, mean direction of the visible light
};

/// Converts transfer of order 2 with one channel. If no light arrives, the bent normal is the entry of
/// `normals`, or +Y if `normals` is empty.
AmbientVisibility ambient_visibility_of(const Transfer& transfer, std::span<const glm::vec3> normals = {});

struct OcclusionResult {
    AmbientVisibility ambient_visibility; ///< [receivers]
    BakeStatistics statistics;
};

/// Computes ambient occlusion of every vertex of `scene`. Throws the same errors as `bake`.
OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress = {});

} // namespace prt
