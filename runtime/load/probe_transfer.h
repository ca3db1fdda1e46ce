#pragma once

// Compressed transfer of probes in glTF files.

#include "prt/core/transfer_volume.h"
#include "prt/load/scene.h"
#include "runtime/load/gltf_data.h"

#include <optional>

namespace prt {

/// Reads the probes of `set`. The origin of the grid is relative to that of `scene`. Throws `Error` if they
/// are damaged.
ProbeLayout read_probe_layout(const GltfData& data, const Scene& scene, const Json& set);

/// Returns the compressed volume of the file; empty if it has none, or a raw one. Throws `Error` if the
/// volume is damaged, too large or of another version.
std::optional<CompressedVolume> read_compressed_volume(const GltfData& data, const Scene& scene);

} // namespace prt
