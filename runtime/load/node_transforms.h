#pragma once

// Transforms of nodes.

#include "runtime/load/gltf_model.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Transform of a node relative to its parent.
struct LocalPose {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    std::optional<glm::dmat4> matrix; ///< replaces the other members if set

    glm::dmat4 transform() const;
};

/// The nodes of a scene, parents before children.
struct NodeTree {
    struct Entry {
        int node, parent; ///< -1: a root
    };
    std::vector<Entry> order;
    std::vector<LocalPose> poses; ///< [nodes of the file]
};

/// Returns the tree of the default scene (or the first scene; or all root nodes if there is no scene). Throws
/// `Error` if the hierarchy is not a tree.
NodeTree node_tree(const GltfModel& model);

/// Returns world matrices, [nodes of the file]; the identity for nodes outside the scene. `poses` as in
/// `tree`.
std::vector<glm::dmat4> world_matrices(const NodeTree& tree, std::span<const LocalPose> poses);

struct NodeTransform {
    int node = 0;
    glm::dmat4 world{1};
    bool visible = true; ///< KHR_node_visibility of the node and all its ancestors
};

/// Returns world transforms of the nodes of `node_tree`, in its order.
std::vector<NodeTransform> world_transforms(const GltfModel& model);

/// Returns the printable name of a node; "node N" if it has none.
std::string name_of(const GltfModel& model, int node);

} // namespace prt
