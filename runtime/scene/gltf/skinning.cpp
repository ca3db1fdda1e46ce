// Skins and morph targets in the pose of the file (glTF 2.0, section 3.7.3).
#include "gltf/skinning.h"

#include "gltf/accessor.h"
#include "prt/support/error.h"

#include <glm/gtc/type_ptr.hpp>

#include <string>

namespace prt {

std::vector<glm::dmat4> joint_matrices(const tinygltf::Model& model, int skin_index,
                                       const std::vector<NodeTransform>& nodes) {
    if (static_cast<std::size_t>(skin_index) >= model.skins.size())
        throw Error("skin " + std::to_string(skin_index) + " is not there");
    const tinygltf::Skin& skin = model.skins[static_cast<std::size_t>(skin_index)];
    std::vector<glm::dmat4> world(model.nodes.size(), glm::dmat4(1));
    for (const NodeTransform& node : nodes)
        world[static_cast<std::size_t>(node.node)] = node.world;
    std::vector<float> inverse_bind;
    if (skin.inverseBindMatrices >= 0)
        inverse_bind = read_floats(model, skin.inverseBindMatrices, 16);
    std::vector<glm::dmat4> joints;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const int node = skin.joints[j];
        if (node < 0 || static_cast<std::size_t>(node) >= world.size())
            throw Error("a joint of its skin is not there");
        glm::dmat4 matrix = world[static_cast<std::size_t>(node)];
        if ((j + 1) * 16 <= inverse_bind.size())
            matrix *= glm::dmat4(glm::make_mat4(&inverse_bind[j * 16]));
        joints.push_back(matrix);
    }
    return joints;
}

std::vector<glm::dmat4> skin_matrices(const tinygltf::Model& model, const std::vector<glm::dmat4>& joints,
                                      const tinygltf::Primitive& primitive, std::size_t vertices) {
    std::vector<glm::dmat4> matrices(vertices, glm::dmat4(0));
    std::vector<double> totals(vertices, 0);
    for (int set = 0;; ++set) {
        const auto joints_attribute = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const auto weights_attribute = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        if (joints_attribute == primitive.attributes.end() || weights_attribute == primitive.attributes.end())
            break;
        const auto indices = read_unsigned(model, joints_attribute->second, 4);
        const auto weights = read_floats(model, weights_attribute->second, 4);
        if (indices.size() != 4 * vertices || weights.size() != 4 * vertices)
            throw Error("JOINTS or WEIGHTS have another number of elements than POSITION");
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double weight = weights[i];
            if (weight == 0)
                continue;
            if (indices[i] >= joints.size())
                throw Error("joint " + std::to_string(indices[i]) + " is beyond the " +
                            std::to_string(joints.size()) + " of its skin");
            matrices[i / 4] += weight * joints[indices[i]];
            totals[i / 4] += weight;
        }
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        if (totals[i] > 0)
            matrices[i] /= totals[i];
        else
            matrices[i] = glm::dmat4(1);
    }
    return matrices;
}

} // namespace prt
