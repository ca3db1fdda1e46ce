#pragma once

// Light of suns alone with sharp shadows: a renderer adds it to the light of transfer with shadow maps.

#include "prt/sun.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct SunRays {
    int rays = 256; ///< rays for each receiver and sun over the sun's disc; one ray for a sun without extent
    std::uint64_t seed = 0;
    int threads = 0; ///< number of threads; 0: all
};

/// Computes exit radiance for albedo 1 of every vertex of `scene` under `suns`, shadowed by rays, without
/// bounces: [receivers]. Thin sheets transmit it as in `direct` transfer, to which it is added. `solid`
/// surfaces, whose light comes out of a medium, get zero. Throws `Cancelled` when asked to stop.
std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const Sun> suns,
                                    const SunRays& options = {}, const Progress& progress = {});

} // namespace prt
