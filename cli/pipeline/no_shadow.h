#pragma once

// Materials that cast no shadow, such as shells around a scene that let light in.

#include "prt/load/scene.h"

#include <string>
#include <vector>

namespace prt::pipeline {

/// Marks surfaces of these materials as transparent to light. Throws `Error` for a name that no material has.
void leave_out_shadows(Scene& scene, const std::vector<std::string>& materials);

} // namespace prt::pipeline
