#pragma once

// Lightmaps for relighting in glTF files: PRTKIT_lightmap of docs/format.md. Experimental.

#include "prt/gltf.h"
#include "prt/lightmap.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace prt {

/// Maximum number of texels along a side of a map.
inline constexpr int kMaxLightmapTexels = 16384;

/// Writes raw transfer of texels into `document`, from which `scene` was extracted. Replaces existing
/// transfer.
void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap);

/// Returns the raw transfer of texels in the file; empty if absent. Throws `Error` if it is damaged.
std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene);

/// A compressed lightmap whose words are encoded as images.
struct EncodedLightmap {
    CompressedLightmap lightmap;                ///< without receivers
    std::vector<std::vector<std::byte>> images; ///< [maps][words] PNG
};

/// Writes a compressed lightmap with encoded images into `document`, from which `scene` was extracted.
/// prt/lightmap_file.h encodes the images.
void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap);
/// Returns the compressed lightmap in the file with encoded images; empty if absent. Throws `Error` if it is
/// damaged. prt/lightmap_file.h decodes the images.
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene);

} // namespace prt
