#pragma once

#include "mesh.h"

namespace examples {

/// Returns a leaf, pointed at both ends, bent about its middle vein and drooping towards the tip. `along` and
/// `side` are orthogonal unit vectors; it has columns x rows cells, with `columns` even so that the vein is
/// an edge.
Mesh leaf(const glm::vec3& base, const glm::vec3& along, const glm::vec3& side, float length, int columns,
          int rows);

} // namespace examples
