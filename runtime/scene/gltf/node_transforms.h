#pragma once

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <vector>

namespace prt {

struct NodeTransform {
    int node = 0;
    glm::dmat4 world{1};
    bool visible = true; ///< KHR_node_visibility, of the node and all above it
};

/// World transforms of the nodes of the default scene (or the first; of all root nodes where there is no
/// scene), parents before children. Throws `Error` when the hierarchy is no tree.
std::vector<NodeTransform> world_transforms(const tinygltf::Model& model);

} // namespace prt
