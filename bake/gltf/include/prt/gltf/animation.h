#pragma once

// Animation in glTF files: reads nodes, skins and animations, and poses the vertices of a scene.
// Experimental.
//
//     const AnimatedScene figure(load_gltf("figure.glb"));
//     const Animation& walk = figure.animations().front();
//     const auto nodes = figure.pose(walk, std::fmod(seconds, walk.duration));
//     const Scene now = figure.posed(nodes, placement);          // for rays
//     const auto palette = figure.matrices(0, nodes);            // for a vertex shader
//
// Weights of morph targets are not animated; they keep the values in the file.

#include "prt/gltf/gltf.h"
#include "prt/gltf/levels.h"

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

/// Property of a node that a channel animates, relative to the parent of the node.
enum class AnimatedPart { translation, rotation, scale };
/// Interpolation between two keyframes, as in glTF: value of the earlier key, linear (rotations: spherical),
/// or cubic Hermite spline.
enum class Interpolation { step, linear, cubic_spline };

/// Keyframes of one property of a node.
struct AnimationChannel {
    std::size_t node = 0; ///< index of the animated node in the file
    AnimatedPart part = AnimatedPart::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times; ///< [keys] seconds, never decreasing; at least one
    /// [keys] xyz and 0 for translation (metres) and scale (factors), or quaternions xyzw for rotation. With
    /// Interpolation::cubic_spline [keys][3]: in-tangent, value and out-tangent of each key.
    std::vector<glm::vec4> values;
};

/// An animation: channels that play together.
struct Animation {
    std::string name;    ///< name in the file; may be empty
    double duration = 0; ///< latest time of a key in `channels`, seconds; 0 without channels
    double speed = 0;    ///< walking speed along +Z in metres per second at which the feet do not slide, from
                         ///< extras.speed of the animation; 0: the file has no value in 0..1000
    std::vector<AnimationChannel> channels; ///< without those of morph targets, and those without a node
};

/// Returns the value of a channel at time `seconds`: xyz and 0 for translation and scale, or a unit
/// quaternion xyzw for rotation. Before the first and after the last key the value is that of the key. Linear
/// interpolation of rotations follows the shorter arc (glTF 2.0, appendix C). The channel must have a key.
glm::dvec4 value_at(const AnimationChannel& channel, double seconds);

/// Returns whether the file has at least one animation. Does not read or check the animations.
bool has_animations(const GltfDocument& document);

/// Levels of detail that an `AnimatedScene` contains.
enum class ReadLevels {
    finest, ///< level 0, as `extract_scene`
    all,    ///< also coarser levels, as `extract_levels`
};

/// A scene with its nodes, skins and animations. Immutable, thread-safe. The world is that of the file, in
/// metres; its origin is not Scene::origin.
class AnimatedScene {
public:
    /// Reads the scene and its animations; keeps no reference to `document`. Throws `Error`, whose message
    /// contains the path of the file, if a skin, a joint weight or an animation is invalid, if a channel
    /// animates a node that has a matrix, or if the keyframes need too much memory for the size of the file.
    /// Also throws the errors of `extract_scene`, or of `extract_levels`.
    explicit AnimatedScene(const GltfDocument& document, ReadLevels levels = ReadLevels::finest);

    /// Returns the scene in the pose of the file, equal to that of `extract_scene` or `extract_levels`.
    const Scene& scene() const { return leveled_.scene; }
    /// Returns scene() with the levels of its nodes; without nodes for ReadLevels::finest.
    const LeveledScene& leveled() const { return leveled_; }
    /// Returns all animations of the file, in file order.
    const std::vector<Animation>& animations() const { return animations_; }
    /// Returns all skins of the file, in file order.
    const std::vector<Skin>& skins() const { return skins_; }
    /// Returns the skinning data, [Scene::vertex_arrays].
    const std::vector<MovingVertices>& vertices() const { return vertices_; }
    /// Returns the number of nodes of the file.
    std::size_t nodes() const;

    /// Returns the matrices from the frame of each node to the world, in the pose of the file: [nodes()].
    /// Nodes outside the default scene have the identity, except coarser levels of detail.
    std::vector<glm::dmat4> rest() const;
    /// Returns the matrices from the frame of each node to the world at time `seconds` of `animation`:
    /// [nodes()], as `rest` for nodes outside the default scene. `animation`: one of animations(). `seconds`
    /// is clamped to the keys of each channel; for a loop, pass the remainder of the duration.
    std::vector<glm::dmat4> pose(const Animation& animation, double seconds) const;

    /// Returns the matrices from the frame of each node to the world, [nodes()], if this model follows
    /// `leader` in its pose `nodes`: a node with the name of a node of `leader` moves from its position in
    /// the file as that node does, and others move with their parents. Throws `Error` if a name of `leader`
    /// is ambiguous, or if a joint of a skin has no such name, and none of its ancestors has.
    std::vector<glm::dmat4> followed(const AnimatedScene& leader, std::span<const glm::dmat4> nodes) const;

    /// Returns the matrices from the mesh to the world that a vertex array uses. Without a skin: one matrix,
    /// the world matrix of the node. With a skin: [joints + 1], for each joint its world matrix times its
    /// inverse bind matrix, then the identity for vertices without a joint. `vertex_array`: index into
    /// vertices(). `nodes`: result of `rest` or `pose`.
    std::vector<glm::dmat4> matrices(std::size_t vertex_array, std::span<const glm::dmat4> nodes) const;

    /// Returns a copy of scene() without lights, in the pose `nodes`, for ray tracing. `nodes`: result of
    /// `rest` or `pose`. `placement`: matrix from the world of the file to the positions of the result, whose
    /// Scene::origin is 0. Triangles keep the winding order of scene(), also if `placement` mirrors.
    Scene posed(std::span<const glm::dmat4> nodes, const glm::dmat4& placement) const;
    /// Returns `posed` with the levels of `of`, which are nodes of `leveled`.
    LeveledScene posed_levels(std::span<const glm::dmat4> nodes, const glm::dmat4& placement,
                              std::vector<LeveledNode> of) const;

private:
    LeveledScene leveled_;
    std::vector<MovingVertices> vertices_;
    std::vector<Skin> skins_;
    std::vector<Animation> animations_;
    std::vector<std::string> names_; ///< [nodes()]
    std::shared_ptr<const NodeTree> tree_;
};

} // namespace prt
