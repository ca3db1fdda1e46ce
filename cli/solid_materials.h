#pragma once

#include "inputs.h"

#include <vector>

namespace prt::cli {

/// Which materials have something inside that all light passes: they are no thin sheets, and suns light them
/// by transfer alone. [materials] A file says so of media that glTF describes; those of --subsurface a bake
/// tells by what it lacks, direct light at any vertex; a compressed file does not, and texels have none.
std::vector<bool> solid_materials(const SceneFile& model);

} // namespace prt::cli
