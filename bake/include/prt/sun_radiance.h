#pragma once

// What suns alone give, with sharp shadows: what a renderer adds to the light of transfer by shadow maps.

#include "prt/sun_disc.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct SunRays {
    int rays = 256; ///< for each receiver and sun, over its disc; one where it has no extent
    std::uint64_t seed = 0;
    int threads = 0; ///< 0: all
};

/// Exit radiance for albedo 1 of every vertex of `scene` under `suns`, shadowed by rays, without bounces:
/// [receivers]. Through thin sheets it comes as through `direct` transfer, to which it adds; `solid`
/// surfaces, whose light comes out of a medium, get none. Throws `Cancelled` when asked to stop.
std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const SunDisc> suns,
                                    const SunRays& options = {}, const Progress& progress = {});

} // namespace prt
