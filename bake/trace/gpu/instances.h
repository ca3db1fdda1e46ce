#pragma once

// Meshes that stand in a scene several times.

#include "prt/scene.h"

#include <glm/mat4x3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// A copy of a primitive, turned, scaled and moved.
struct Instance {
    std::uint32_t primitive;
    glm::mat4x3 transform; ///< from the first copy to this one
};

/// Primitives of the same geometry, each within what rounding does to positions: [meshes][instances], the
/// copy that is nearest to the origin first. Those that stand alone are left out.
std::vector<std::vector<Instance>> find_instances(const Scene& scene);

} // namespace prt
