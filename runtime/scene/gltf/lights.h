#pragma once

// Lights of KHR_lights_punctual.

#include "gltf/contents.h"
#include "gltf/node_transforms.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// Of a light or of emission, in any channel: beyond, sums of squares pass what a float holds.
inline constexpr double kMostIntensity = 1e9;

/// Gives spots without the member "spot", which tinygltf asks for, an empty one. Returns whether there were
/// any.
bool complete_spots(Json& json);

/// Multiplies the intensity of all lights in `json`, which may hold none. What is wrong with them is left for
/// `read_lights` to refuse.
void scale_lights(Json& json, double factor);

/// The lights of all visible nodes, in the order of the nodes; positions are seen from `origin`. Throws
/// `Error` for what the extension does not allow.
std::vector<PunctualLight> read_lights(const GltfContents& contents, const std::vector<NodeTransform>& nodes,
                                       const glm::dvec3& origin, std::vector<std::string>& notices);

} // namespace prt
