#pragma once

// Compressed transfer of probes in glTF files.

#include "prt/core/transfer_volume.h"
#include "prt/load/scene.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace prt {

inline constexpr int kVolumeVersion = 2;

/// Members of PRTKIT_transfer_volume that raw and compressed volumes share.
struct ProbeLayout {
    int order = 0; ///< order of the incident light
    VolumeGrid grid;
    std::vector<ProbeVisibility> visibility; ///< [probes]
};
/// Reads `extension`. The origin of the grid is relative to that of `scene`. Throws `Error` if it is damaged.
ProbeLayout read_probe_layout(const GltfData& data, const Scene& scene, const Json& extension);

/// Returns the compressed volume of the file; empty if it has none, or a raw one. Throws `Error` if the
/// volume is damaged, too large or of another version.
std::optional<CompressedVolume> read_compressed_volume(const GltfData& data, const Scene& scene);

} // namespace prt
