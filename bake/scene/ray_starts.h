#pragma once

// Where the rays of a vertex start (docs/math.md, section 3).

#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

enum class Side { front, back };

/// For every vertex where its rays start on that side of the surface, seen from its position, in units of
/// RayScene::surface_offset: [receivers]. A start lies at least half a unit above the plane of every face of
/// the vertex where any place does, and four units along the surface towards the part that the vertex stands
/// for: a vertex on the edge of a floor lies in the plane of the wall that rises there, and without this no
/// rounding tells on which side of it.
std::vector<glm::vec3> ray_starts(const Scene& scene, Side side);

} // namespace prt
