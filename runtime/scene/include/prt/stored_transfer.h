#pragma once

// Raw transfer of glTF files in its stored format, for block-by-block processing. Experimental.

#include "prt/gltf.h"
#include "prt/transfer_view.h"

#include <optional>

namespace prt {

/// A bake with transfer in its stored format.
struct StoredBake {
    StoredTransfer transfer; ///< receivers in the order of the scene's vertex arrays
    BakeRecord record;
};

/// Reads transfer like `read_transfer`, without converting float16.
std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene);

} // namespace prt
