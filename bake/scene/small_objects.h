#pragma once

#include "prt/scene.h"

#include <optional>
#include <string>

namespace prt {

/// A line about the primitives of `scene` that are so small, and so far from its middle, that rays start
/// visibly off their surfaces: where the longest side is 128 times RayScene::coordinate_offset, transfer errs
/// by some 3 %. Nothing where there are none.
std::optional<std::string> small_object_notice(const Scene& scene);

} // namespace prt
