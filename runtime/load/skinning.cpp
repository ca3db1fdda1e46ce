// Reads skins (glTF 2.0, section 3.7.3).
#include "runtime/load/skinning.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace prt {
namespace {

/// Writes set `set` of joints and weights, interleaved with the other sets.
void read_set(const GltfModel& model, std::span<const int> accessors, std::size_t set, std::size_t joints,
              MovingVertices& moving) {
    const auto indices = read_unsigned(model, accessors[0], 4);
    const auto weights = read_floats(model, accessors[1], 4);
    const std::size_t numbers = moving.weights.size() / moving.influences * 4;
    if (indices.size() != numbers || weights.size() != numbers)
        throw Error("JOINTS or WEIGHTS and POSITION have different numbers of elements");
    for (std::size_t i = 0; i < numbers; ++i) {
        if (!(weights[i] >= 0 && std::isfinite(weights[i])))
            throw Error("a joint weight of vertex " + std::to_string(i / 4) + " is " +
                        std::to_string(weights[i]) + ", but must be finite and not negative");
        if (weights[i] == 0)
            continue;
        if (indices[i] >= joints)
            throw Error("joint " + std::to_string(indices[i]) + " does not exist: the skin has " +
                        counted(joints, "joint"));
        const std::size_t at = i / 4 * moving.influences + 4 * set + i % 4;
        moving.matrices[at] = indices[i];
        moving.weights[at] = weights[i];
    }
}

/// Returns the accessors of the sets of joints and weights, two each.
std::vector<int> influence_accessors(const GltfPrimitive& primitive) {
    std::vector<int> accessors;
    for (int set = 0;; ++set) {
        const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const auto weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        if (joints == primitive.attributes.end() || weights == primitive.attributes.end())
            return accessors;
        accessors.insert(accessors.end(), {joints->second, weights->second});
    }
}

} // namespace

Skin read_skin(const GltfModel& model, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.skins.size())
        throw Error("skin " + std::to_string(index) + " does not exist");
    const GltfSkin& file = model.skins[static_cast<std::size_t>(index)];
    std::vector<float> inverse_bind;
    if (file.inverseBindMatrices >= 0) {
        inverse_bind = read_floats(model, file.inverseBindMatrices, 16);
        if (inverse_bind.size() < 16 * file.joints.size())
            throw Error("skin " + std::to_string(index) + " has " + counted(file.joints.size(), "joint") +
                        ", but " +
                        counted(inverse_bind.size() / 16, "inverse bind matrix", "inverse bind matrices"));
    }
    Skin skin;
    for (std::size_t j = 0; j < file.joints.size(); ++j) {
        const int node = file.joints[j];
        if (node < 0 || static_cast<std::size_t>(node) >= model.nodes.size())
            throw Error("joint " + std::to_string(j) + " of skin " + std::to_string(index) + " is node " +
                        std::to_string(node) + ", which does not exist");
        skin.joints.push_back(static_cast<std::size_t>(node));
        skin.inverse_bind.push_back(inverse_bind.empty() ? glm::dmat4(1)
                                                         : glm::dmat4(glm::make_mat4(&inverse_bind[j * 16])));
    }
    return skin;
}

std::vector<glm::dmat4> joint_palette(const Skin& skin, std::span<const glm::dmat4> world) {
    std::vector<glm::dmat4> palette;
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
        palette.push_back(world[skin.joints[j]] * skin.inverse_bind[j]);
    palette.emplace_back(1);
    return palette;
}

void read_influences(const GltfModel& model, const GltfPrimitive& primitive, std::size_t joints,
                     std::size_t vertices, MovingVertices& moving) {
    const std::vector<int> accessors = influence_accessors(primitive);
    moving.influences = std::max<std::size_t>(1, 2 * accessors.size());
    moving.matrices.assign(vertices * moving.influences, 0);
    moving.weights.assign(vertices * moving.influences, 0);
    for (std::size_t set = 0; 2 * set < accessors.size(); ++set)
        read_set(model, std::span(accessors).subspan(2 * set, 2), set, joints, moving);
    for (std::size_t i = 0; i < vertices; ++i) {
        const std::size_t first = i * moving.influences;
        double total = 0;
        for (std::size_t k = 0; k < moving.influences; ++k)
            total += moving.weights[first + k];
        if (total > 0)
            continue;
        for (std::size_t k = 0; k < moving.influences; ++k)
            moving.weights[first + k] = k == 0 ? 1 : 0;
        moving.matrices[first] = static_cast<std::uint32_t>(joints);
    }
}

glm::dmat4 vertex_matrix(std::span<const glm::dmat4> palette, const MovingVertices& moving,
                         std::size_t vertex) {
    if (moving.skin < 0)
        return palette[0];
    glm::dmat4 sum(0);
    double total = 0;
    for (std::size_t k = vertex * moving.influences; k < (vertex + 1) * moving.influences; ++k) {
        const double weight = moving.weights[k];
        if (weight == 0)
            continue;
        sum += weight * palette[moving.matrices[k]];
        total += weight;
    }
    return sum / total;
}

} // namespace prt
