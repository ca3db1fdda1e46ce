// A scene with animated nodes.
#include "bake/gltf/extraction.h"
#include "bake/gltf/followed_nodes.h"
#include "bake/gltf/read_animations.h"
#include "prt/core/error.h"
#include "prt/gltf/animation.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/node_transforms.h"
#include "runtime/load/skinning.h"
#include "runtime/load/transformed_normal.h"

#include <algorithm>

namespace prt {
namespace {

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, std::span<const std::uint32_t> from,
                          std::size_t each) {
    std::vector<Value> result;
    result.reserve(from.size() * each);
    for (const std::uint32_t i : from)
        result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(i * each),
                      values.begin() + static_cast<std::ptrdiff_t>((i + 1) * each));
    return result;
}

/// Converts vertices of the file to those of the scene, if flat normals split some.
void split_as(const VertexArray& vertices, MovingVertices& moving) {
    if (vertices.source.empty())
        return;
    moving.positions = picked(moving.positions, vertices.source, 1);
    if (!moving.normals.empty())
        moving.normals = picked(moving.normals, vertices.source, 1);
    if (moving.skin < 0)
        return;
    moving.matrices = picked(moving.matrices, vertices.source, moving.influences);
    moving.weights = picked(moving.weights, vertices.source, moving.influences);
}

/// Adds normals that the file lacks: those of the scene, transformed back by the inverse matrices.
void complete_normals(const VertexArray& vertices, std::span<const glm::dmat4> palette,
                      MovingVertices& moving) {
    moving.normals.resize(vertices.size(), glm::vec3(0));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        moving.normals[i] = unit_or_zero(moving.normals[i]);
        if (moving.normals[i] == glm::vec3(0))
            moving.normals[i] = normal_before(vertices.normals[i], vertex_matrix(palette, moving, i));
    }
}

void apply(const glm::dvec4& value, AnimatedPart part, LocalPose& pose) {
    if (part == AnimatedPart::rotation)
        pose.rotation = glm::dquat(value.w, value.x, value.y, value.z);
    else
        (part == AnimatedPart::scale ? pose.scale : pose.translation) = glm::dvec3(value);
}

} // namespace

bool has_animations(const GltfDocument& document) {
    return !document.contents().parsed.animations.empty();
}

AnimatedScene::AnimatedScene(const GltfDocument& document, ReadLevels levels) {
    const GltfContents& contents = document.contents();
    try {
        Geometry geometry = levels == ReadLevels::all ? extract_with_levels(contents, Keep::moving)
                                                      : extract(contents, Keep::moving);
        vertices_ = std::move(geometry.moving);
        NodeTree tree = node_tree(contents.model);
        tree.order.insert(tree.order.end(), geometry.nodes.outside.begin(), geometry.nodes.outside.end());
        tree_ = std::make_shared<const NodeTree>(std::move(tree));
        names_ = node_names(contents.model);
        leveled_ = leveled_scene(contents, std::move(geometry));
        for (std::size_t skin = 0; skin < contents.model.skins.size(); ++skin)
            skins_.push_back(read_skin(contents.model, static_cast<int>(skin)));
        animations_ = read_animations(contents);
        const std::vector<glm::dmat4> standing = rest();
        for (std::size_t array = 0; array < vertices_.size(); ++array) {
            split_as(scene().vertex_arrays[array], vertices_[array]);
            complete_normals(scene().vertex_arrays[array], matrices(array, standing), vertices_[array]);
        }
    } catch (const std::exception& error) { // errors of prtkit and of the standard library
        throw Error(contents.path.string() + ": " + in_plain_words(error));
    }
}

std::size_t AnimatedScene::nodes() const {
    return tree_->poses.size();
}

std::vector<glm::dmat4> AnimatedScene::rest() const {
    return world_matrices(*tree_, tree_->poses);
}

std::vector<glm::dmat4> AnimatedScene::pose(const Animation& animation, double seconds) const {
    std::vector<LocalPose> poses = tree_->poses;
    for (const AnimationChannel& channel : animation.channels)
        apply(value_at(channel, seconds), channel.part, poses[channel.node]);
    return world_matrices(*tree_, poses);
}

std::vector<glm::dmat4> AnimatedScene::followed(const AnimatedScene& leader,
                                                std::span<const glm::dmat4> nodes) const {
    const std::vector<int> follows = followed_nodes(leader.names_, names_, tree_->order);
    for (const MovingVertices& vertices : vertices_)
        for (const std::size_t joint : vertices.skin < 0
                                           ? std::vector<std::size_t>{}
                                           : skins_[static_cast<std::size_t>(vertices.skin)].joints)
            if (follows[joint] < 0)
                throw Error("has no node with the name of joint node " + std::to_string(joint) + " '" +
                            printable(names_[joint]) + "' of the high-poly model");
    const std::vector<glm::dmat4> led = leader.rest();
    std::vector<glm::dmat4> own = rest();
    for (std::size_t node = 0; node < own.size(); ++node)
        if (follows[node] >= 0) { // moves as that node does from the pose of the file
            const auto n = static_cast<std::size_t>(follows[node]);
            own[node] = nodes[n] * glm::inverse(led[n]) * own[node];
        }
    return own;
}

std::vector<glm::dmat4> AnimatedScene::matrices(std::size_t vertex_array,
                                                std::span<const glm::dmat4> nodes) const {
    const MovingVertices& moving = vertices_[vertex_array];
    if (moving.skin < 0)
        return {nodes[moving.node]};
    return joint_palette(skins_[static_cast<std::size_t>(moving.skin)], nodes);
}

Scene AnimatedScene::posed(std::span<const glm::dmat4> nodes, const glm::dmat4& placement) const {
    Scene scene = leveled_.scene;
    scene.origin = glm::dvec3(0);
    scene.lights.clear();
    for (std::size_t array = 0; array < vertices_.size(); ++array) {
        std::vector<glm::dmat4> palette = matrices(array, nodes);
        for (glm::dmat4& matrix : palette)
            matrix = placement * matrix;
        const MovingVertices& moving = vertices_[array];
        VertexArray& vertices = scene.vertex_arrays[array];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const glm::dmat4 matrix = vertex_matrix(palette, moving, i);
            vertices.positions[i] = glm::vec3(matrix * glm::dvec4(moving.positions[i], 1));
            vertices.normals[i] = transformed_normal(moving.normals[i], matrix);
        }
    }
    return scene;
}

LeveledScene AnimatedScene::posed_levels(std::span<const glm::dmat4> nodes, const glm::dmat4& placement,
                                         std::vector<LeveledNode> of) const {
    return {
        posed(nodes, placement), leveled_.finest_receivers, leveled_.finest_primitives, std::move(of), {}};
}

} // namespace prt
