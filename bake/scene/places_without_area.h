#pragma once

// Vertices of triangles without area, which take the light of a vertex at the same position.

#include "prt/receivers.h"
#include "prt/transfer.h"

#include <cstddef>

namespace prt {

/// Copies to each of the first `fronts` receivers that has a normal and no area the transfer of the receiver
/// with an area at its position whose normal is nearest. Others stay dark.
void fill_without_area(const Receivers& receivers, std::size_t fronts, Transfer& transfer);

} // namespace prt
