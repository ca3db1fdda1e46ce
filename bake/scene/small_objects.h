#pragma once

// Notice about objects that are too small for single precision.

#include "prt/load/scene.h"

#include <optional>
#include <string>

namespace prt {

/// Returns a notice about primitives of `scene` that are so small and so far from the origin that the offset
/// of rays from their surfaces is visible: if the longest side is 128 times RayScene::coordinate_offset, the
/// error of transfer is about 3 %. Returns nothing if there are no such primitives.
std::optional<std::string> small_object_notice(const Scene& scene);

} // namespace prt
