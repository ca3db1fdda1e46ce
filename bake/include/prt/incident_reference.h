#pragma once

// What comes in at places in free space by path tracing: the reference of volumes. Experimental.

#include "prt/scene_lamps.h"
#include "prt/surface_radiance.h"
#include "prt/transfer_volume.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// Places that objects may be at.
struct FreePlaces {
    std::vector<glm::vec3> positions;
    std::vector<float> distances; ///< of the nearest surface, metres
    std::vector<bool> shut;       ///< from which no ray of 256 reaches the sky
};

/// `count` places all over the box of `grid`, in the same box as the scene; those from which more than a
/// quarter of directions end at backs of surfaces are none. Throws `Error` where there is next to none.
FreePlaces free_places_in(const TraceScene& scene, const VolumeGrid& grid, std::size_t count,
                          std::uint64_t seed);

struct IncidentOptions {
    int paths = 512; ///< of a place, in each half
    /// That shine beside the light; none: all are dark.
    const SceneLamps* lamps = nullptr;
    std::uint64_t seed = 1;
    int threads = 0; ///< 0: all
};

/// Coefficients of the light that comes in, [places][order²], twice and independently, so that a product of
/// differences from both has no noise in the mean: of the light itself, without direct light of suns that the
/// renderer adds, and of lamps, directly too. Surfaces are as `PathTracer` takes them. Throws `Cancelled`
/// when asked to stop.
std::array<std::vector<glm::vec3>, 2>
incident_reference(const TraceScene& scene, const std::vector<glm::vec3>& places, int order,
                   const MeasuredLight& light, const IncidentOptions& options, const Progress& progress = {});

} // namespace prt
