#pragma once

// Incident light at positions in free space, by path tracing: the reference for volumes. Experimental.

#include "bake/reference/scene_lamps.h"
#include "bake/reference/surface_radiance.h"
#include "prt/core/transfer_volume.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// Random positions in free space, which is the space outside geometry. Arrays are parallel, [positions].
struct FreePositions {
    std::vector<glm::vec3> positions; ///< metres, relative to Scene::origin
    /// Distance to the nearest surface in metres, estimated with 256 rays; infinite if no ray hits a surface.
    std::vector<float> distances;
    std::vector<bool> shut; ///< true if none of 256 rays reaches the sky
};

/// Returns exactly `count` random positions in the intersection of the box of `grid` and the bounding box of
/// the scene, which must overlap. A position is inside geometry, and is replaced by another, if more than a
/// quarter of 256 rays end at back sides of single-sided surfaces. Throws `Error` if about 20 · `count`
/// attempts do not suffice. The result depends only on the arguments.
FreePositions free_positions_in(const TraceScene& scene, const VolumeGrid& grid, std::size_t count,
                                std::uint64_t seed);

/// Settings of `incident_reference`.
struct IncidentOptions {
    int paths = 512; ///< number of paths per position for each of the two estimates, at least 1
    /// Lamps whose light is added; null: all lamps are dark.
    const SceneLamps* lamps = nullptr;
    std::uint64_t seed = 1; ///< seed of the random paths
    int threads = 0;        ///< number of threads; 0: all
};

/// Returns two estimates of the incident light at `positions` (metres, relative to Scene::origin) from
/// independent random numbers. Each estimate is SH coefficients of incident radiance, [positions][order²],
/// linear Rec. 709; `order` must be in 1..kMaxIncidentOrder. To measure a squared error, multiply the error
/// against one estimate by the error against the other: the mean of the product has no noise of the
/// estimates. The light contains all light of IncidentOptions::lamps, and distant light except direct light
/// of ReferenceLight::suns and of DistantLight::suns. Surfaces scatter as in `PathTracer`, with their base
/// colors; light bounces without a limit. Throws `Cancelled` after a stop request.
std::array<std::vector<glm::vec3>, 2> incident_reference(const TraceScene& scene,
                                                         const std::vector<glm::vec3>& positions, int order,
                                                         const ReferenceLight& light,
                                                         const IncidentOptions& options,
                                                         const Progress& progress = {});

} // namespace prt
