#pragma once

#include "prt/gltf.h"

namespace prt {

/// The same document, read anew: its model knows what was changed.
GltfDocument reread(const GltfDocument& document, Instancing instancing = Instancing::nodes);

} // namespace prt
