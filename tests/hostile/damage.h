#pragma once

#include "support/glb_file.h"

#include <cstdint>

namespace prt::test {

/// `file` with damage to one place of its compressed transfer, or of the mesh that this is of, or to a few.
/// The same seed gives the same.
GlbFile damaged(GlbFile file, std::uint32_t seed);

} // namespace prt::test
