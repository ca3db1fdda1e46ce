#pragma once

// Compressed transfer of texels in glTF files.

#include "prt/load/model.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

namespace prt {

/// Reads the maps of `set`, and the maps of the primitives of `scene`.
LightmapLayout read_layout_of_maps(const GltfData& data, const Scene& scene, const Json& set);

/// Returns the bytes of an image file, by its index.
using ImageBytes = std::function<std::span<const std::byte>(std::size_t)>;
/// Returns the compressed lightmap of the file; empty if it has none, or a raw one. Does not decode the
/// images of its words. `images`: number of images. Throws `Error` if the lightmap is damaged, too large or
/// of another version.
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfData& data, const Scene& scene,
                                                     std::size_t images, const ImageBytes& image);

} // namespace prt
