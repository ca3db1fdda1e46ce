#pragma once

// Raw transfer of glTF files in its stored format. Code that processes it block by block needs no float copy.
// Experimental.

#include "prt/core/transfer_view.h"
#include "prt/gltf/gltf.h"

#include <optional>

namespace prt {

/// Raw transfer in the number format of the file, with the record of its bake.
struct StoredBake {
    StoredTransfer transfer; ///< receivers in the order of the receivers of the scene
    BakeRecord record;       ///< settings and results of the bake
};

/// Returns the raw transfer in the file without conversion to float; empty if the file has no raw transfer at
/// vertices. If only a part of the vertex arrays has float16, all numbers are floats. `scene` was extracted
/// from `document`. Throws the errors of `read_transfer`.
std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene);

} // namespace prt
