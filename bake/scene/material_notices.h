#pragma once

#include "prt/scene.h"

#include <string>
#include <vector>

namespace prt {

/// What a user should know about how light meets the materials of `scene`, a line each.
std::vector<std::string> material_notices(const Scene& scene, bool with_bounces);

} // namespace prt
