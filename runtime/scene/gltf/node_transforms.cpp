// World transforms of nodes, by the hierarchy of the default scene.
#include "gltf/node_transforms.h"

#include "prt/support/error.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <string>

namespace prt {
namespace {

glm::dmat4 local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16)
        return glm::make_mat4(node.matrix.data());
    glm::dmat4 local(1);
    if (node.translation.size() == 3)
        local = glm::translate(local, glm::make_vec3(node.translation.data()));
    if (node.rotation.size() == 4)
        local *= glm::mat4_cast(glm::normalize(
            glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
    if (node.scale.size() == 3)
        local = glm::scale(local, glm::make_vec3(node.scale.data()));
    return local;
}

bool is_visible(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    return found == node.extensions.end() || !found->second.Has("visible") ||
           found->second.Get("visible").Get<bool>();
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
        if (static_cast<std::size_t>(scene) >= model.scenes.size())
            throw Error("the default scene " + std::to_string(scene) + " is not there");
        return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
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

std::vector<NodeTransform> world_transforms(const tinygltf::Model& model) {
    std::vector<NodeTransform> result;
    std::vector<bool> visited(model.nodes.size(), false);
    const auto add = [&](int node, const NodeTransform& parent) {
        if (node < 0 || static_cast<std::size_t>(node) >= visited.size())
            throw Error("node " + std::to_string(node) + " is not there");
        if (visited[static_cast<std::size_t>(node)])
            throw Error("node " + std::to_string(node) + " has two parents or is its own ancestor");
        visited[static_cast<std::size_t>(node)] = true;
        const tinygltf::Node& file = model.nodes[static_cast<std::size_t>(node)];
        result.push_back({node, parent.world * local_transform(file), parent.visible && is_visible(file)});
    };
    for (const int root : root_nodes(model))
        add(root, {});
    for (std::size_t i = 0; i < result.size(); ++i) {
        const NodeTransform parent = result[i];
        for (const int child : model.nodes[static_cast<std::size_t>(parent.node)].children)
            add(child, parent);
    }
    return result;
}

} // namespace prt
