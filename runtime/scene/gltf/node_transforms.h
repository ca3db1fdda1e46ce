#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Where a node is against its parent.
struct LocalPose {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    std::optional<glm::dmat4> matrix; ///< instead

    glm::dmat4 transform() const;
};

/// The nodes of a scene, parents before children.
struct NodeTree {
    struct Place {
        int node, parent; ///< -1: a root
    };
    std::vector<Place> order;
    std::vector<LocalPose> poses; ///< [nodes of the file]
};

/// Of the default scene (or the first; of all root nodes where there is no scene). Throws `Error` when the
/// hierarchy is no tree.
NodeTree node_tree(const tinygltf::Model& model);

/// [nodes of the file]; the identity for those of no scene. `poses` as `tree` has them.
std::vector<glm::dmat4> world_matrices(const NodeTree& tree, std::span<const LocalPose> poses);

/// What KHR_node_visibility says of it alone.
bool is_visible(const tinygltf::Node& node);

struct NodeTransform {
    int node = 0;
    glm::dmat4 world{1};
    bool visible = true; ///< KHR_node_visibility, of the node and all above it
};

/// World transforms of the nodes of `node_tree`, in its order.
std::vector<NodeTransform> world_transforms(const tinygltf::Model& model);

/// The printable name of a node; "node N" where it has none.
std::string name_of(const tinygltf::Model& model, int node);

} // namespace prt
