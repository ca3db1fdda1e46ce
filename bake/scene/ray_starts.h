#pragma once

// Origins of the rays of a vertex (docs/math.md, section 3).

#include "prt/load/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

enum class Side { front, back };

/// Returns for every vertex the origin of its rays on that side of the surface, relative to its position, in
/// units of RayScene::surface_offset: [receivers]. An origin is at least half a unit above the plane of every
/// face of the vertex, if such a point exists, and up to four units along the surface towards the area that
/// the vertex represents. Reason: a vertex on the edge of a floor is in the plane of a wall that rises there,
/// and without this offset rounding would decide on which side of the wall it is.
std::vector<glm::vec3> ray_starts(const Scene& scene, Side side);

} // namespace prt
