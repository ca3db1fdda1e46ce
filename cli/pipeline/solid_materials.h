#pragma once

#include "cli/pipeline/model.h"

#include <vector>

namespace prt::pipeline {

/// Returns the materials with a medium inside that all light passes: they are not thin sheets, and suns light
/// them only through transfer. [materials] Media that glTF describes are found in the file. Media of
/// --subsurface are found in a bake, because no vertex of such a material has direct light; a compressed file
/// does not contain this information, and texels have no media.
std::vector<bool> solid_materials(const SceneFile& model);

/// Throws `Error` if `scene` shows one of the `solid` materials, because the path tracer does not enter
/// media.
void check_no_media(const Scene& scene, const std::vector<bool>& solid);

} // namespace prt::pipeline
