#pragma once

// Meshes that a scene contains several times.

#include "prt/load/scene.h"

#include <glm/mat4x3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// A copy of a primitive, rotated, scaled and translated.
struct CopiedPrimitive {
    std::uint32_t primitive;
    glm::mat4x3 transform; ///< transform from the first copy to this one
};

/// Finds primitives with the same geometry up to rounding of positions: [meshes][copies], the copy nearest
/// to the origin first. Primitives without copies are omitted.
std::vector<std::vector<CopiedPrimitive>> find_copies(const Scene& scene);

} // namespace prt
