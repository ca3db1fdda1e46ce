#pragma once

// Zonal lobes of vertices in glTF files: PRTKIT_lobes of docs/format.md. Experimental.

#include "prt/gltf.h"
#include "prt/lobes.h"

#include <cstdint>
#include <optional>

namespace prt {

/// Settings of the lobe fit; written to the file and shown by `prt info`. A number that the file does not
/// contain is 0.
struct LobeRecord {
    int poses = 0;          ///< number of poses in the fit
    int rays = 0;           ///< number of rays per vertex in each pose
    int bounces = 0;        ///< number of bounces; 0: direct light only
    std::uint64_t seed = 0; ///< seed of the random numbers of the rays
};

/// Lobes as stored in a file, with the record of their fit.
struct StoredLobes {
    LobeModel model; ///< vertices in the order of the receivers of the scene
    LobeRecord record;
};

/// Writes lobes into `document`, from which `scene` was extracted. Removes all other transfer of surfaces
/// (vertices and lightmaps), because other transfer is valid for a single pose only. Changes the meshes as
/// `write_transfer` does; call only one function that changes the meshes per document. Throws the errors of
/// `check_lobes` and `write_transfer`.
void write_lobes(GltfDocument& document, const Scene& scene, const StoredLobes& lobes);

/// Returns the lobes in the file; empty if the file has no lobes. `scene` was extracted from `document`.
/// Throws `Error` if the lobes are damaged, too large or of another version.
std::optional<StoredLobes> read_lobes(const GltfDocument& document, const Scene& scene);

} // namespace prt
