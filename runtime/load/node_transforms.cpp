// Computes world transforms of nodes from the hierarchy of the default scene.
#include "runtime/load/node_transforms.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <string>

namespace prt {
namespace {

LocalPose local_pose(const GltfNode& node) {
    LocalPose pose;
    if (node.matrix.size() == 16)
        pose.matrix = glm::make_mat4(node.matrix.data());
    if (node.translation.size() == 3)
        pose.translation = glm::make_vec3(node.translation.data());
    if (node.rotation.size() == 4)
        pose.rotation = glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (node.scale.size() == 3)
        pose.scale = glm::make_vec3(node.scale.data());
    return pose;
}

std::vector<int> root_nodes(const GltfModel& model) {
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
        if (static_cast<std::size_t>(scene) >= model.scenes.size())
            throw Error("the default scene " + std::to_string(scene) + " does not exist");
        return model.scenes[static_cast<std::size_t>(scene)];
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const GltfNode& node : model.nodes)
        for (const int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i])
            roots.push_back(static_cast<int>(i));
    return roots;
}

} // namespace

glm::dmat4 LocalPose::transform() const {
    if (matrix)
        return *matrix;
    const glm::dmat4 rotated =
        glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(glm::normalize(rotation));
    return glm::scale(rotated, scale);
}

NodeTree node_tree(const GltfModel& model) {
    NodeTree tree;
    std::vector<bool> visited(model.nodes.size(), false);
    const auto add = [&](int node, int parent) {
        if (node < 0 || static_cast<std::size_t>(node) >= visited.size())
            throw Error("node " + std::to_string(node) + " does not exist");
        if (visited[static_cast<std::size_t>(node)])
            throw Error("node " + std::to_string(node) + " has two parents or is its own ancestor");
        visited[static_cast<std::size_t>(node)] = true;
        tree.order.push_back({node, parent});
    };
    for (const int root : root_nodes(model))
        add(root, -1);
    for (std::size_t i = 0; i < tree.order.size(); ++i) {
        const int parent = tree.order[i].node;
        for (const int child : model.nodes[static_cast<std::size_t>(parent)].children)
            add(child, parent);
    }
    for (const GltfNode& node : model.nodes)
        tree.poses.push_back(local_pose(node));
    return tree;
}

std::vector<glm::dmat4> world_matrices(const NodeTree& tree, std::span<const LocalPose> poses) {
    std::vector<glm::dmat4> world(poses.size(), glm::dmat4(1));
    for (const NodeTree::Entry& position : tree.order) {
        const auto node = static_cast<std::size_t>(position.node);
        const glm::dmat4 local = poses[node].transform();
        world[node] = position.parent < 0 ? local : world[static_cast<std::size_t>(position.parent)] * local;
    }
    return world;
}

std::vector<NodeTransform> world_transforms(const GltfModel& model) {
    const NodeTree tree = node_tree(model);
    const std::vector<glm::dmat4> world = world_matrices(tree, tree.poses);
    std::vector<bool> visible(model.nodes.size(), true);
    std::vector<NodeTransform> result;
    for (const NodeTree::Entry& position : tree.order) {
        const auto node = static_cast<std::size_t>(position.node);
        visible[node] = (position.parent < 0 || visible[static_cast<std::size_t>(position.parent)]) &&
                        model.nodes[node].visible;
        result.push_back({position.node, world[node], visible[node]});
    }
    return result;
}

std::string name_of(const GltfModel& model, int node) {
    const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
    return name.empty() ? "node " + std::to_string(node) : printable(name);
}

} // namespace prt
