#pragma once

#include "mesh.h"

namespace examples {

/// Pointed at both ends, bent about its middle vein and hanging down towards the tip. `along` and `side` are
/// unit and at right angles; columns x rows cells, `columns` even so that the vein is an edge.
Mesh leaf(const glm::vec3& base, const glm::vec3& along, const glm::vec3& side, float length, int columns,
          int rows);

} // namespace examples
