#pragma once

// Lightmaps for relighting in glTF files: PRTKIT_lightmap of docs/format.md. Experimental.

#include "prt/gltf.h"
#include "prt/lightmap.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace prt {

/// Maximum width and maximum height of a lightmap in a file, in texels.
inline constexpr int kMaxLightmapTexels = 16384;

/// Writes raw transfer of texels into `document`, from which `scene` was extracted. Removes all existing
/// transfer of surfaces: of vertices, of texels, and lobes. Changes the meshes as `write_transfer` does; call
/// only one function that changes the meshes per document. Throws the errors of `write_transfer`.
void write_lightmap(GltfDocument& document, const Scene& scene, const BakedLightmap& lightmap);

/// Returns the raw transfer of texels in the file; empty if the file has no lightmap or a compressed one.
/// `scene` was extracted from `document`. Throws `Error` if the lightmap is damaged, too large or of another
/// version, or if the file also has transfer of vertices.
std::optional<BakedLightmap> read_lightmap(const GltfDocument& document, const Scene& scene);

/// A compressed lightmap whose packed words (cluster and weights of a texel) are encoded as images.
struct EncodedLightmap {
    /// The lightmap without the clusters and weights of receivers, which `images` contain.
    CompressedLightmap lightmap;
    /// [maps][words per texel] PNG files, one for each word of the texels of a map.
    std::vector<std::vector<std::byte>> images;
};

/// Writes a compressed lightmap with encoded images into `document`, from which `scene` was extracted.
/// `lightmap` must have at least one map and packed weights. Removes all existing transfer of surfaces and
/// changes the meshes, as `write_lightmap` does. Throws the errors of `write_transfer`. prt/lightmap_file.h
/// has functions that encode the images.
void write_encoded_lightmap(GltfDocument& document, const Scene& scene, const EncodedLightmap& lightmap);
/// Returns the compressed lightmap in the file, with encoded images; empty if the file has no lightmap or a
/// raw one. `scene` was extracted from `document`. Throws the errors of `read_lightmap`; does not decode the
/// images. prt/lightmap_file.h has functions that decode them.
std::optional<EncodedLightmap> read_encoded_lightmap(const GltfDocument& document, const Scene& scene);

} // namespace prt
