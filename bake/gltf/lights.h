#pragma once

// Lights of KHR_lights_punctual.

#include "bake/gltf/contents.h"
#include "prt/load/scene.h"
#include "runtime/load/node_transforms.h"

#include <vector>

namespace prt {

/// Maximum intensity of a light or of emission, in any channel: above it, sums of squares overflow a float.
inline constexpr double kMaxIntensity = 1e9;

/// Adds an empty member "spot", which tinygltf requires, to spots without it. Returns whether there were any.
bool complete_spots(Json& json);

/// Multiplies the intensity of all lights in `json`, if there are any. Invalid lights are left for
/// `read_lights` to reject.
void scale_lights(Json& json, double factor);

/// Returns the lights of all visible nodes, in the order of the nodes; positions are relative to `origin`.
/// Throws `Error` for values that the extension does not allow.
std::vector<PunctualLight> read_lights(const GltfContents& contents, const std::vector<NodeTransform>& nodes,
                                       const glm::dvec3& origin, std::vector<std::string>& notices);

} // namespace prt
