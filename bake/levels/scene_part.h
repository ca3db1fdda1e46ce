#pragma once

#include "prt/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Some primitives of a scene as a scene of their own, with its materials and lights, without its images.
struct ScenePart {
    Scene scene;
    std::vector<std::uint32_t> receivers; ///< [receivers of the part] in the scene that it is of
};
ScenePart scene_part(const Scene& scene, std::span<const std::size_t> primitives);

} // namespace prt
