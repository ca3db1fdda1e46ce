#pragma once

// Baked light for viewers that do not know the extensions of prtkit: docs/format.md, "Fallback".
// Experimental.

#include "prt/gltf.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// By what radiance is multiplied so that it fits 0..1 on all of the surface but 0.5 %: `radiance` and
/// `areas` [receivers]. 1 where all is black.
float fallback_exposure(std::span<const glm::vec3> radiance, std::span<const float> areas);

/// Writes `radiance` [receivers], exit radiance for albedo 1, times `exposure` and the vertices' own colors
/// as COLOR_0, clamped to 0..1, and makes materials unlit. `document` holds clustered transfer, `scene` was
/// extracted from it. Primitives whose material shines, is glass or is unlit stay as they are. Returns how
/// many primitives show the light. Whoever loads the file by `load_gltf` sees none of it. Throws `Error`.
std::size_t write_fallback(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                           float exposure);

/// The same colors and unlit materials for a `document` without transfer: the light is all that it shows. The
/// vertices' own colors and the materials' lit shading are replaced.
std::size_t write_unlit(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                        float exposure);

} // namespace prt
