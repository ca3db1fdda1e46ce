#pragma once

// Baked light for viewers without support for the prtkit extensions: docs/format.md, "Fallback".
// Experimental.

#include "prt/gltf.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// Returns the factor on radiance that maps all of the surface except 0.5 % of its area to 0..1. `radiance`
/// and `areas` are [receivers]. Returns 1 if the radiance is black.
float fallback_exposure(std::span<const glm::vec3> radiance, std::span<const float> areas);

/// Writes COLOR_0: `radiance` [receivers], exit radiance for albedo 1, times `exposure` and the vertex
/// colors, clamped to 0..1. Makes materials unlit. `document` must contain clustered transfer, and `scene`
/// must be extracted from it. Primitives with emissive, glass or unlit materials are not changed. Returns the
/// number of primitives that show the light. `load_gltf` ignores the fallback. Throws `Error`.
std::size_t write_fallback(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                           float exposure);

/// The same colors and unlit materials for a `document` without transfer: the light is all that it shows. The
/// vertices' own colors and the materials' lit shading are replaced.
std::size_t write_unlit(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                        float exposure);

} // namespace prt
