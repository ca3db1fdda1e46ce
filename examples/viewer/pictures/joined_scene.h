#pragma once

#include "prt/scene.h"
#include "prt/texture.h"

#include <vector>

namespace viewer {

/// Adds the surfaces of `other`, whose positions are seen from the origin of `scene`, with its materials and
/// images. Lights of `other` are left out.
void join(prt::Scene& scene, const prt::Scene& other);
prt::Scene joined(prt::Scene scene, const prt::Scene& other);

} // namespace viewer
