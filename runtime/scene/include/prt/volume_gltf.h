#pragma once

// Volumes of transfer in glTF files: PRTKIT_transfer_volume of docs/format.md. A file can have a volume in
// addition to transfer of surfaces. Experimental.

#include "prt/gltf.h"
#include "prt/transfer_volume.h"

#include <optional>

namespace prt {

/// Writes a raw volume, whose grid is relative to Scene::origin, into `document`, from which `scene` was
/// extracted. Replaces an existing volume, raw or compressed. Does not change transfer of surfaces.
void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume);
/// Writes a compressed volume, whose grid is relative to Scene::origin, into `document`, from which `scene`
/// was extracted. Replaces an existing volume, raw or compressed. Does not change transfer of surfaces.
/// Throws `Error` unless the weights are packed.
void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume);

/// Returns the raw volume in the file; empty if the file has no volume or a compressed one. `scene` was
/// extracted from `document`. Throws `Error` if the volume is damaged, too large or of another version.
std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene);
/// Returns the compressed volume in the file; empty if the file has no volume or a raw one. `scene` was
/// extracted from `document`. Throws `Error` if the volume is damaged, too large or of another version.
std::optional<CompressedVolume> read_compressed_volume(const GltfDocument& document, const Scene& scene);

/// Removes the volume, raw or compressed, from `document`, and frees its memory. Does nothing if there is no
/// volume.
void discard_volume(GltfDocument& document);

} // namespace prt
