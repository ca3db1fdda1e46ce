#pragma once

// Light of the vertices of a model.

#include "bake/pipeline/sun_radiance.h"
#include "cli/pipeline/model.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt::pipeline {

/// Returns exit radiance for albedo 1, [vertices], by transfer and lobes: from the sky, from lamps, and from
/// suns after a bounce. `model` must have transfer of vertices.
std::vector<glm::vec3> lit_vertices(const SceneFile& model, const Lighting& lighting, int threads);

/// Adds the direct light of suns, by rays, to `radiance` [vertices].
void add_direct_suns(const TraceScene& scene, std::span<const Sun> suns, const SunRays& rays,
                     const Progress& progress, std::span<glm::vec3> radiance);

/// Returns whether suns can only be lit with the sky, because the transfer of `model` has no separate direct
/// term.
bool suns_stay_in_sky(const SceneFile& model);

} // namespace prt::pipeline
