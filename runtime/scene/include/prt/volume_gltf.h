#pragma once

// Volumes of transfer in glTF files: PRTKIT_transfer_volume of docs/format.md. They stand beside whatever
// transfer the surfaces of a file have. Experimental.

#include "prt/gltf.h"
#include "prt/transfer_volume.h"

#include <optional>

namespace prt {

/// Writes a raw or compressed volume into `document`, from which `scene` was extracted, in the place of any
/// that is there. Weights have to be packed.
void write_volume(GltfDocument& document, const Scene& scene, const BakedVolume& volume);
void write_volume(GltfDocument& document, const Scene& scene, const CompressedVolume& volume);

/// The volume in the file; nothing when it holds none of that kind. Throws `Error` when it is damaged.
std::optional<BakedVolume> read_volume(const GltfDocument& document, const Scene& scene);
std::optional<CompressedVolume> read_compressed_volume(const GltfDocument& document, const Scene& scene);

/// Takes the volume out of `document`, if there is one.
void discard_volume(GltfDocument& document);

} // namespace prt
