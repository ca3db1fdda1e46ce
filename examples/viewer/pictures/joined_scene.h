#pragma once

#include "prt/load/scene.h"
#include "prt/render/texture.h"

#include <vector>

namespace viewer {

/// Adds the surfaces of `other` to `scene`, with their materials and images. Positions of `other` are
/// relative to the origin of `scene`. Lights of `other` are omitted.
void join(prt::Scene& scene, const prt::Scene& other);
prt::Scene joined(prt::Scene scene, const prt::Scene& other);

} // namespace viewer
