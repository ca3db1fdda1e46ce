#pragma once

#include "support/glb_file.h"

namespace prt::test {

/// Returns a file that is demanding for writers: instances, missing normals, strips, an image in a separate
/// file, sparse data.
GlbFile demanding_file();

} // namespace prt::test
