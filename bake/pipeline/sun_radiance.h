#pragma once

// Direct light of suns with sharp shadows at vertices, like the light that a renderer with shadow maps adds
// to the light of transfer.

#include "bake/scene/trace_scene.h"
#include "prt/core/light.h"
#include "prt/core/progress.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Settings of `sun_radiance`.
struct SunRays {
    int rays = 256; ///< number of rays per receiver and sun, at least 1, spread over the disc of the sun; a
                    ///< sun with half angle 0 gets one ray
    std::uint64_t seed = 0; ///< seed of the rotation of the rays about the center of a sun's disc
    int threads = 0;        ///< number of threads; 0: all
};

/// Returns the exit radiance for albedo 1 of every vertex of `scene` under direct light of `suns`, with
/// shadows and without bounces: [vertices], in the order of Scene::vertex_arrays, linear Rec. 709. The caller
/// adds it to the light of the `direct` term under the sky without these suns. Includes light that thin
/// sheets transmit from their back sides, like that term. Zero for vertices on surfaces whose material is
/// `solid` in `scene` (TraceSceneOptions::solid), because a medium inside spreads their light, and for
/// vertices without an area or a normal. Throws the errors of TraceScene::rays, and `Cancelled` after a stop
/// request.
std::vector<glm::vec3> sun_radiance(const TraceScene& scene, std::span<const Sun> suns,
                                    const SunRays& options = {}, const Progress& progress = {});

} // namespace prt
