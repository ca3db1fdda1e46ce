#pragma once

// Raw transfer of glTF files in its stored format. Code that processes it block by block needs no float copy.
// Experimental.

#include "prt/gltf.h"
#include "prt/transfer_view.h"

#include <optional>

namespace prt {

/// Raw transfer in its stored format, with the record of its bake.
struct StoredBake {
    StoredTransfer transfer; ///< receivers in the order of the scene's vertex arrays
    BakeRecord record;
};

/// Returns the raw transfer in the file without converting float16; empty if absent. Throws the errors of
/// `read_transfer`.
std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene);

} // namespace prt
