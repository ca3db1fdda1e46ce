#pragma once

// A subset of a scene's primitives.

#include "prt/load/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Some primitives of a scene as a separate scene, with its materials and lights, without its images.
struct ScenePart {
    Scene scene;
    std::vector<std::uint32_t> receivers; ///< [receivers of the part] receivers of the original scene
};
ScenePart scene_part(const Scene& scene, std::span<const std::size_t> primitives);

} // namespace prt
