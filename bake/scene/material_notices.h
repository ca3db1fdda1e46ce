#pragma once

// Notices about materials.

#include "prt/load/scene.h"

#include <string>
#include <vector>

namespace prt {

/// Returns notices about materials of `scene` that are simplified by the model of light, one line each.
std::vector<std::string> material_notices(const Scene& scene, bool with_bounces);

} // namespace prt
