#pragma once

// What moves in a glTF file: its nodes, skins and animations, and the vertices that go with them.
// Experimental.
//
//     const AnimatedScene figure(load_gltf("figure.glb"));
//     const Animation& walk = figure.animations().front();
//     const auto nodes = figure.pose(walk, std::fmod(seconds, walk.duration));
//     const Scene now = figure.posed(nodes, placement);          // for rays
//     const auto palette = figure.matrices(0, nodes);            // for a vertex shader
//
// Weights of morph targets do not move: they stay as the file has them.

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

enum class AnimatedPart { translation, rotation, scale };
enum class Interpolation { step, linear, cubic_spline };

/// How one part of a node changes in time.
struct AnimationChannel {
    std::size_t node = 0; ///< index in the file
    AnimatedPart part = AnimatedPart::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times; ///< seconds, none before the last
    /// xyz, or quaternions xyzw: [keys]; of splines [keys][tangent before, value, tangent after].
    std::vector<glm::vec4> values;
};

struct Animation {
    std::string name;
    double duration = 0; ///< seconds, of the last key
    double speed = 0; ///< metres per second along +Z at which its feet stand still; 0: extras.speed says none
    std::vector<AnimationChannel> channels;
};

/// What a channel says at a time, by which the first and the last key hold on: rotations are unit and turn
/// the short way (glTF 2.0, appendix C).
glm::dvec4 value_at(const AnimationChannel& channel, double seconds);

/// Joints, by node, and what takes a vertex from where the mesh was bound to the joint's own frame.
struct Skin {
    std::vector<std::size_t> joints;      ///< nodes
    std::vector<glm::dmat4> inverse_bind; ///< [joints]
};

/// How the vertices of one of `Scene::vertex_arrays` move: each by the sum of its weights times its matrices,
/// over the sum of its weights. What lies in one node without a skin has one matrix.
struct MovingVertices {
    std::size_t node = 0;
    int skin = -1;                             ///< -1: none
    std::vector<glm::vec3> positions, normals; ///< before any matrix, metres; unit
    std::size_t influences = 1;                ///< of a vertex
    std::vector<std::uint32_t> matrices; ///< [vertices][influences], below those of AnimatedScene::matrices
    std::vector<float> weights;          ///< [vertices][influences], 0: whatever the matrix
};

/// The matrix that takes a vertex to the world, blended of `palette`: AnimatedScene::matrices of its array.
glm::dmat4 vertex_matrix(std::span<const glm::dmat4> palette, const MovingVertices& moving,
                         std::size_t vertex);

/// Whether a file has animations at all; nothing of them is read.
bool has_animations(const GltfDocument& document);

/// Immutable once made; thread-safe.
class AnimatedScene {
public:
    /// Throws `Error` that names the file and the place: for skins without their joints, joints and nodes
    /// that are not there, times that are not finite or fall, values that are not finite or too few, and as
    /// `extract_scene` does.
    explicit AnimatedScene(const GltfDocument& document);

    /// As the file stands: what `extract_scene` gives.
    const Scene& scene() const { return scene_; }
    const std::vector<Animation>& animations() const { return animations_; }
    const std::vector<Skin>& skins() const { return skins_; }
    const std::vector<MovingVertices>& vertices() const { return vertices_; } ///< [Scene::vertex_arrays]
    std::size_t nodes() const;

    /// World matrices of all nodes of the file as it stands, and at a time of an animation of it. Nodes of no
    /// scene have the identity.
    std::vector<glm::dmat4> rest() const;
    std::vector<glm::dmat4> pose(const Animation& animation, double seconds) const;

    /// What the vertices of an array are multiplied by: of its node, or of the joints of its skin, joint
    /// world times inverse bind, and behind them the identity for vertices that hang on none.
    std::vector<glm::dmat4> matrices(std::size_t vertex_array, std::span<const glm::dmat4> nodes) const;

    /// The scene with its vertices where `nodes` have them, for rays. `placement` takes the file's world to
    /// positions of what is returned, whose origin is 0, without lights. What faces which way is as in
    /// `scene`.
    Scene posed(std::span<const glm::dmat4> nodes, const glm::dmat4& placement) const;

private:
    Scene scene_;
    std::vector<MovingVertices> vertices_;
    std::vector<Skin> skins_;
    std::vector<Animation> animations_;
    std::shared_ptr<const NodeTree> tree_;
};

} // namespace prt
