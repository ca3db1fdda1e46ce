#pragma once

#include "support/glb_file.h"

#include <cstdint>

namespace prt::test {

/// Returns `file` with damage at one or a few positions of its compressed transfer, or of the mesh with the
/// transfer. Equal seeds produce equal files.
GlbFile damaged(GlbFile file, std::uint32_t seed);

} // namespace prt::test
