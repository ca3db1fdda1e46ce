#pragma once

// Refreshing of a document after edits.

#include "prt/gltf/gltf.h"

namespace prt {

/// Returns the document after writing and parsing it, so that its model includes all changes.
GltfDocument reparse(const GltfDocument& document, Instancing instancing = Instancing::nodes);

} // namespace prt
