#pragma once

#include "support/glb_file.h"

namespace prt::test {

/// Three instances of a triangle, and one that is drawn once, with compressed transfer that is random.
GlbFile instanced_triangles();

} // namespace prt::test
