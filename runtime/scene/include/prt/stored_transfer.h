#pragma once

// Raw transfer of glTF files as it is stored, for who works on it block by block. Experimental.

#include "prt/gltf.h"
#include "prt/transfer_view.h"

#include <optional>

namespace prt {

/// A bake, its transfer as the file has it.
struct StoredBake {
    StoredTransfer transfer; ///< receivers in the order of the scene's vertex arrays
    BakeRecord record;
};

/// `read_transfer`, where float16 stays as it is.
std::optional<StoredBake> read_stored_transfer(const GltfDocument& document, const Scene& scene);

} // namespace prt
