// Writes the nodes, skin and animations of a skeleton.

#include "write_skeleton.h"

#include "gltf_data.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

namespace examples {
namespace {

constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;

std::vector<double> doubles(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

/// Adds a node for each joint and returns the first's index; the others follow it.
int add_joint_nodes(tinygltf::Model& model, const std::vector<Joint>& joints) {
    const auto first = static_cast<int>(model.nodes.size());
    for (const Joint& joint : joints) {
        const auto parent = static_cast<std::size_t>(joint.parent);
        tinygltf::Node node;
        node.name = joint.name;
        node.translation =
            doubles(joint.parent < 0 ? joint.position : joint.position - joints[parent].position);
        const auto index = static_cast<int>(model.nodes.size());
        model.nodes.push_back(node);
        if (joint.parent < 0)
            model.scenes[0].nodes.push_back(index);
        else
            model.nodes[static_cast<std::size_t>(first) + parent].children.push_back(index);
    }
    return first;
}

tinygltf::Skin make_skin(tinygltf::Model& model, const std::vector<Joint>& joints, int first_node) {
    tinygltf::Skin skin;
    skin.skeleton = first_node;
    std::vector<glm::mat4> inverse_bind;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        skin.joints.push_back(first_node + static_cast<int>(j));
        inverse_bind.push_back(glm::translate(glm::mat4(1), -joints[j].position));
    }
    skin.inverseBindMatrices = add_accessor(model, inverse_bind, {kFloat, TINYGLTF_TYPE_MAT4});
    return skin;
}

/// Adds a channel that animates node `node` with `values` at the times of accessor `times`.
void add_channel(tinygltf::Animation& animation, int times, int values, int node, const char* path) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = values;
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
}

std::vector<glm::vec4> quaternions(const std::vector<glm::quat>& rotations) {
    std::vector<glm::vec4> written;
    for (const glm::quat& q : rotations)
        written.emplace_back(q.x, q.y, q.z, q.w);
    return written;
}

tinygltf::Animation make_animation(tinygltf::Model& model, const Movement& movement, int first_node) {
    tinygltf::Animation animation;
    animation.name = movement.name;
    const int times = add_accessor(model, movement.times, {kFloat, TINYGLTF_TYPE_SCALAR});
    set_bounds(model.accessors.back(), movement.times);
    for (const JointTrack& track : movement.tracks) {
        const int node = first_node + track.joint;
        add_channel(animation, times,
                    add_accessor(model, quaternions(track.rotations), {kFloat, TINYGLTF_TYPE_VEC4}), node,
                    "rotation");
        if (!track.positions.empty())
            add_channel(animation, times, add_accessor(model, track.positions, {kFloat, TINYGLTF_TYPE_VEC3}),
                        node, "translation");
    }
    tinygltf::Value::Object extras;
    extras["speed"] = tinygltf::Value(static_cast<double>(movement.speed));
    animation.extras = tinygltf::Value(extras);
    return animation;
}

} // namespace

void add_skin_attributes(tinygltf::Model& model, tinygltf::Primitive& primitive, const SkinWeights& skin) {
    if (skin.joints.empty())
        return;
    primitive.attributes["JOINTS_0"] = add_accessor(
        model, skin.joints,
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER});
    primitive.attributes["WEIGHTS_0"] =
        add_accessor(model, skin.weights, {kFloat, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER});
}

void add_skeleton(tinygltf::Model& model, const Skeleton& skeleton, int skinned) {
    if (skeleton.joints.empty())
        return;
    const int first_node = add_joint_nodes(model, skeleton.joints);
    model.skins.push_back(make_skin(model, skeleton.joints, first_node));
    model.nodes[static_cast<std::size_t>(skinned)].skin = static_cast<int>(model.skins.size()) - 1;
    for (const Movement& movement : skeleton.movements)
        model.animations.push_back(make_animation(model, movement, first_node));
}

} // namespace examples
