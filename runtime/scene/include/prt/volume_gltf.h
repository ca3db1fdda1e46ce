#pragma once

// Volumes of transfer in glTF files: PRTKIT_transfer_volume of docs/format.md. They are independent of the
// transfer of surfaces in a file. Experimental.

#include "prt/gltf.h"
#include "prt/transfer_volume.h"

#include <optional>

namespace prt {

/// Writes a raw volume into `document`, from which `scene` was extracted. Replaces an existing volume.
void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume);
/// Writes a compressed volume, whose weights must be packed, into `document`, from which `scene` was
/// extracted. Replaces an existing volume.
void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume);

/// Returns the raw volume in the file; empty if absent. Throws `Error` if it is damaged.
std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene);
/// Returns the compressed volume in the file; empty if absent. Throws `Error` if it is damaged.
std::optional<CompressedVolume> read_compressed_volume(const GltfDocument& document, const Scene& scene);

/// Removes the volume from `document`, if there is one.
void discard_volume(GltfDocument& document);

} // namespace prt
