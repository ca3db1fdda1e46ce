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

/// A compressed lightmap whose words are still images.
struct EncodedLightmap {
    CompressedLightmap lightmap;                ///< without receivers
    std::vector<std::vector<std::byte>> images; ///< [maps][words] PNG
};

/// Write and read a compressed lightmap with encoded images. prt/lightmap_file.h encodes and decodes the
/// images. Reading returns no value if the file has no such lightmap, and throws `Error` if it is damaged.
void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap);
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene);

} // namespace prt
