#pragma once

// Vertices of triangles without area; they take the light of a vertex at the same position.

#include "bake/scene/receivers.h"
#include "prt/core/transfer.h"

#include <cstddef>

namespace prt {

/// Copies transfer to each of the first `fronts` receivers that has a normal but no area. The source is the
/// receiver with an area at the same position whose normal is nearest. Receivers without a source stay dark.
void fill_without_area(const Receivers& receivers, std::size_t fronts, Transfer& transfer);

} // namespace prt
