#pragma once

// Baked light for viewers without support for the prtkit extensions: docs/format.md, "Fallback".
// Experimental.

#include "prt/gltf.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// Returns the factor on radiance that maps all of the surface to 0..1, except 0.5 % of its area. `radiance`
/// and `areas` are [receivers]. Returns 1 if the radiance is black.
float fallback_exposure(std::span<const glm::vec3> radiance, std::span<const float> areas);

/// Writes baked colors as COLOR_0 and makes materials unlit, so that other viewers show the light;
/// `load_gltf` ignores both. COLOR_0 is `radiance` [receivers] (exit radiance for albedo 1) times `exposure`
/// and the vertex colors, clamped to 0..1. Primitives with emissive, glass or unlit materials are not
/// changed. Returns the number of changed primitives. `scene` must be extracted from `document`. Throws
/// `Error` unless `document` contains clustered transfer.
std::size_t write_fallback(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                           float exposure);

/// Writes the colors of `write_fallback` and makes materials unlit, for a document without transfer. They
/// replace the vertex colors and lit materials of the file. Returns the number of changed primitives.
std::size_t write_unlit(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                        float exposure);

} // namespace prt
