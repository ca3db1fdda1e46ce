#pragma once

// Direct light of suns with sharp shadows, which a renderer with shadow maps adds to the light of transfer.

#include "prt/sun.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Settings of `sun_radiance`.
struct SunRays {
    int rays = 256; ///< number of rays per receiver and sun, spread over the sun's disc; a sun without extent
                    ///< gets one ray
    std::uint64_t seed = 0;
    int threads = 0; ///< number of threads; 0: all
};

/// Computes the exit radiance for albedo 1 of every vertex of `scene` under `suns`, with shadows by rays and
/// without bounces: [receivers]. It is meant to be added to light of the `direct` term, and thin sheets
/// transmit light as in that term. Surfaces that are `solid` in `scene` get zero, because their light comes
/// from the medium inside. Throws `Cancelled` after a stop request.
std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const Sun> suns,
                                    const SunRays& options = {}, const Progress& progress = {});

} // namespace prt
