#pragma once

#include "prt/load/scene.h"

#include <vector>

namespace prt::pipeline {

/// Returns whether all light of each material passes through a medium (`lit_through_medium`), [materials].
std::vector<bool> solid_materials(const Scene& scene);

/// Throws `Error` if `scene` shows one of the `solid` materials, because the path tracer does not enter
/// media.
void check_no_media(const Scene& scene, const std::vector<bool>& solid);

} // namespace prt::pipeline
