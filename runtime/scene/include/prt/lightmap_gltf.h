#pragma once

// Lightmaps that are relit in glTF files: PRTKIT_lightmap of docs/format.md. Experimental.

#include "prt/gltf.h"
#include "prt/lightmap.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace prt {

/// Maps have at most so many texels along a side.
inline constexpr int kMostLightmapTexels = 16384;

/// Writes raw transfer of texels into `document`, from which `scene` was extracted, in the place of any
/// transfer that is there.
void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap);

/// The raw transfer of texels in the file; nothing when it holds none. Throws `Error` when it is damaged.
std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene);

/// A compressed lightmap whose words are still images.
struct EncodedLightmap {
    CompressedLightmap lightmap;                ///< without receivers
    std::vector<std::vector<std::byte>> images; ///< [maps][words] PNG
};

/// The same of a compressed one. prt/lightmap_file.h makes and reads the images.
void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap);
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene);

} // namespace prt
