#pragma once

// Animation in glTF files: nodes, skins and animations, and the vertices that they move. Experimental.
//
//     const AnimatedScene figure(load_gltf("figure.glb"));
//     const Animation& walk = figure.animations().front();
//     const auto nodes = figure.pose(walk, std::fmod(seconds, walk.duration));
//     const Scene now = figure.posed(nodes, placement);          // for rays
//     const auto palette = figure.matrices(0, nodes);            // for a vertex shader
//
// Weights of morph targets are not animated; they keep the values in the file.

#include "prt/gltf.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct NodeTree;

/// Property of a node that a channel animates.
enum class AnimatedPart { translation, rotation, scale };
/// Interpolation between keyframes, as in glTF.
enum class Interpolation { step, linear, cubic_spline };

/// Keyframes of one property of a node.
struct AnimationChannel {
    std::size_t node = 0; ///< index in the file
    AnimatedPart part = AnimatedPart::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times; ///< seconds, in ascending order
    /// [keys] xyz, or quaternions xyzw; for splines [keys][3]: in-tangent, value, out-tangent.
    std::vector<glm::vec4> values;
};

/// An animation: channels that play together.
struct Animation {
    std::string name;
    double duration = 0; ///< seconds, time of the last key
    double speed = 0;    ///< walking speed along +Z in metres per second at which the feet do not slide, from
                         ///< extras.speed; 0: not in the file
    std::vector<AnimationChannel> channels;
};

/// Returns the value of a channel at time `seconds`, which is clamped to the first and the last key.
/// Rotations are unit quaternions and interpolate along the shorter arc (glTF 2.0, appendix C).
glm::dvec4 value_at(const AnimationChannel& channel, double seconds);

/// Joints, and the matrices from the bind pose of the mesh to the frame of each joint.
struct Skin {
    std::vector<std::size_t> joints;      ///< nodes
    std::vector<glm::dmat4> inverse_bind; ///< [joints]
};

/// Skinning data of one of `Scene::vertex_arrays`. Each vertex is transformed by the weighted mean of its
/// matrices. An array without a skin has one matrix, that of its node.
struct MovingVertices {
    std::size_t node = 0;
    int skin = -1;                             ///< -1: no skin
    std::vector<glm::vec3> positions, normals; ///< before any transform; metres, and unit vectors
    std::size_t influences = 1;                ///< per vertex
    std::vector<std::uint32_t> matrices; ///< [vertices][influences], indices into AnimatedScene::matrices
    std::vector<float> weights;          ///< [vertices][influences]; if it is 0, the matrix index is ignored
};

/// Returns the blended matrix from a vertex to the world. `palette` is AnimatedScene::matrices of its array.
glm::dmat4 vertex_matrix(std::span<const glm::dmat4> palette, const MovingVertices& moving,
                         std::size_t vertex);

/// Returns whether a file has animations; does not read them.
bool has_animations(const GltfDocument& document);

/// A scene with its animations. Immutable, thread-safe.
class AnimatedScene {
public:
    /// Reads the scene and its animations. Throws `Error` with the file and the location in it for skins
    /// without joints, missing joints and nodes, times that are not finite or decrease, and values that are
    /// not finite or too few. Also throws the errors of `extract_scene`.
    explicit AnimatedScene(const GltfDocument& document);

    /// The scene in the pose of the file, equal to the result of `extract_scene`.
    const Scene& scene() const { return scene_; }
    const std::vector<Animation>& animations() const { return animations_; }
    const std::vector<Skin>& skins() const { return skins_; }
    const std::vector<MovingVertices>& vertices() const { return vertices_; } ///< [Scene::vertex_arrays]
    /// Number of nodes of the file.
    std::size_t nodes() const;

    /// Returns the world matrices of all nodes in the pose of the file, [nodes()]. Nodes outside the scene
    /// have the identity.
    std::vector<glm::dmat4> rest() const;
    /// Returns the world matrices of all nodes at time `seconds` of `animation`, [nodes()].
    std::vector<glm::dmat4> pose(const Animation& animation, double seconds) const;

    /// Returns the matrices of a vertex array: the matrix of its node, or those of the joints of its skin
    /// (joint world matrix times inverse bind matrix). The last one is the identity, for vertices without a
    /// joint.
    std::vector<glm::dmat4> matrices(std::size_t vertex_array, std::span<const glm::dmat4> nodes) const;

    /// Returns the scene without lights, with the vertices transformed by `nodes`, for ray tracing.
    /// `placement` maps the file's world to the positions of the result, whose origin is 0. The front sides
    /// of triangles are those of `scene()`.
    Scene posed(std::span<const glm::dmat4> nodes, const glm::dmat4& placement) const;

private:
    Scene scene_;
    std::vector<MovingVertices> vertices_;
    std::vector<Skin> skins_;
    std::vector<Animation> animations_;
    std::shared_ptr<const NodeTree> tree_;
};

} // namespace prt
