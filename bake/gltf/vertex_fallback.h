#pragma once

// Writes the light of one lighting as vertex colors, for viewers without support for the prtkit extensions:
// docs/format.md, "Fallback". Experimental.

#include "prt/gltf/gltf.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// Returns an exposure for `write_fallback`: the factor on radiance for which the largest channel is 1 or
/// less on 99.5 % of the area; the brightest 0.5 % are clipped. `radiance`: [receivers of the scene] exit
/// radiance for albedo 1, linear Rec. 709. `areas`: [receivers] m². Returns 1 if the largest channel is at
/// most 1e-6 on 99.5 % of the area.
float fallback_exposure(std::span<const glm::vec3> radiance, std::span<const float> areas);

/// Adds a fallback to a document with compressed transfer: writes light as vertex colors COLOR_0, and makes
/// materials unlit, so that viewers without prtkit show the light. `load_gltf` restores the original colors
/// and materials. COLOR_0 is radiance times `exposure` times the original vertex color, linear, clamped to
/// 0..1. `radiance`: [receivers of `scene`] exit radiance for albedo 1, linear Rec. 709. `exposure`: above 0.
/// Primitives with an emissive, glass or unlit material keep their colors and material. Meshes that several
/// nodes share are copied per node, and primitives without normals get flat normals. Returns the number of
/// primitives that show the light. `scene` must be extracted from `document`. After `write_clustered`, save
/// the document and read the file again before this call. Throws `Error` if `document` has no compressed
/// transfer at vertices (PRTKIT_transfer), if it is damaged, or if the copies need too much memory for
/// the size of the file.
std::size_t write_fallback(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                           float exposure);

/// Writes light as vertex colors COLOR_0 and makes materials unlit, for a document without transfer. The
/// original vertex colors and lit materials are lost. COLOR_0 is radiance times `exposure` times the original
/// vertex color, linear, clamped to 0..1. `radiance`: [receivers of `scene`] exit radiance for albedo 1,
/// linear Rec. 709. `exposure`: above 0. Primitives with an emissive, glass or unlit material keep their
/// colors and material. Meshes that several nodes share are copied per node, and primitives without normals
/// get flat normals. Returns the number of primitives that show the light. `scene` must be extracted from
/// `document`. Throws `Error` if the document is damaged, or if the copies need too much memory for the size
/// of the file.
std::size_t write_unlit(GltfDocument& document, const Scene& scene, std::span<const glm::vec3> radiance,
                        float exposure);

} // namespace prt
