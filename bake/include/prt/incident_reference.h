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

/// Positions in free space where objects can be.
struct FreePositions {
    std::vector<glm::vec3> positions;
    std::vector<float> distances; ///< distance to the nearest surface, metres
    std::vector<bool> shut;       ///< true if none of 256 rays reaches the sky
};

/// Returns `count` random positions in the box of `grid`, clipped to the bounding box of the scene. Positions
/// where more than a quarter of all directions end at back faces are rejected. Throws `Error` if there is
/// almost no free space.
FreePositions free_positions_in(const TraceScene& scene, const VolumeGrid& grid, std::size_t count,
                                std::uint64_t seed);

struct IncidentOptions {
    int paths = 512; ///< paths per position in each half
    /// Lamps that add to the light; null: all lamps are dark.
    const SceneLamps* lamps = nullptr;
    std::uint64_t seed = 1;
    int threads = 0; ///< number of threads; 0: all
};

/// Computes coefficients of the incident light, [places][order²], in two independent halves, so that a
/// product of differences from both has no noise in its mean. The result contains the distant light without
/// direct light of suns that the renderer adds, and the light of lamps, including direct light. Surfaces
/// scatter as in `PathTracer`. Throws `Cancelled` when asked to stop.
std::array<std::vector<glm::vec3>, 2> incident_reference(const TraceScene& scene,
                                                         const std::vector<glm::vec3>& positions, int order,
                                                         const ReferenceLight& light,
                                                         const IncidentOptions& options,
                                                         const Progress& progress = {});

} // namespace prt
