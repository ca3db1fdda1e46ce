#pragma once

// Incident light at positions in free space, by path tracing: the reference for volumes. Experimental.

#include "prt/scene_lamps.h"
#include "prt/surface_radiance.h"
#include "prt/transfer_volume.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// Random positions in free space. Arrays are parallel.
struct FreePositions {
    std::vector<glm::vec3> positions;
    std::vector<float> distances; ///< distance to the nearest surface, metres
    std::vector<bool> shut;       ///< true if none of 256 rays reaches the sky
};

/// Returns exactly `count` random positions in the intersection of the box of `grid` and the bounding box of
/// the scene. A position from which more than a quarter of all directions end at back faces is inside
/// geometry and is replaced by another. Throws `Error` after 20 · `count` attempts.
FreePositions free_positions_in(const TraceScene& scene, const VolumeGrid& grid, std::size_t count,
                                std::uint64_t seed);

/// Settings of `incident_reference`.
struct IncidentOptions {
    int paths = 512; ///< paths per position in each half
    /// Lamps whose light is added; null: all lamps are dark.
    const SceneLamps* lamps = nullptr;
    std::uint64_t seed = 1;
    int threads = 0; ///< number of threads; 0: all
};

/// Returns two estimates of the incident light at `positions`, [positions][order²], from independent random
/// numbers. Multiply the errors against both instead of squaring one: the mean then has no reference noise.
/// The result contains distant light, except direct light of suns that the renderer adds, and all light of
/// lamps. Surfaces scatter as in `PathTracer`. Throws `Cancelled` after a stop request.
std::array<std::vector<glm::vec3>, 2> incident_reference(const TraceScene& scene,
                                                         const std::vector<glm::vec3>& positions, int order,
                                                         const ReferenceLight& light,
                                                         const IncidentOptions& options,
                                                         const Progress& progress = {});

} // namespace prt
