#pragma once

// Ambient occlusion, obscurance and bent normals: transfer of order 2, read as what engines have slots for.
// Experimental.

#include "prt/bake.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

struct OcclusionOptions {
    int rays = 1024;                    ///< per receiver
    std::optional<double> target_error; ///< as of BakeOptions
    FitMode fit = FitMode::automatic;   ///< of vertices
    TracerChoice tracer;                ///< with the fall-off
    Repairs repairs;
    BakeMemory memory;
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
};

/// Of receivers.
struct Openness {
    std::vector<float> ambient;          ///< 0..1: how much of a uniform sky arrives, by the cosine law
    std::vector<glm::vec3> bent_normals; ///< unit, where that light comes from on average
};

/// What transfer of order 2 and one channel says. Where no light comes in, `normals` stand for where from, or
/// +Y where there are none.
Openness openness_of(const Transfer& transfer, std::span<const glm::vec3> normals = {});

struct OcclusionResult {
    Openness openness; ///< [receivers]
    BakeStatistics statistics;
};

/// Of every vertex of a scene. Throws as `bake` does.
OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress = {});

} // namespace prt
