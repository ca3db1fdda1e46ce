#pragma once

// Zonal lobes of vertices in glTF files: PRTKIT_lobes of docs/format.md. Experimental.

#include "prt/gltf.h"
#include "prt/lobes.h"

#include <cstdint>
#include <optional>

namespace prt {

/// How lobes were made; written to the file and shown by `prt info`.
struct LobeRecord {
    int poses = 0; ///< that they were fitted to
    int rays = 0;  ///< of a vertex in a pose
    int bounces = 0;
    std::uint64_t seed = 0;
};

struct StoredLobes {
    LobeModel model; ///< vertices in the order of the scene's vertex arrays
    LobeRecord record;
};

/// Writes them into `document`, from which `scene` was extracted, and takes all other transfer of surfaces
/// out: it would be that of one pose.
void write_lobes(GltfDocument& document, const Scene& scene, const StoredLobes& lobes);

/// Nothing where the file holds none. Throws `Error` when they are damaged.
std::optional<StoredLobes> read_lobes(const GltfDocument& document, const Scene& scene);

} // namespace prt
