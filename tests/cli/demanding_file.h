#pragma once

#include "support/glb_file.h"

namespace prt::test {

/// A file that gives writers work: instances, missing normals, strips, an image beside it, sparse data.
GlbFile demanding_file();

} // namespace prt::test
