#pragma once

// Transfer of an animated model: baked in several poses, then transformed to the frames of its vertices, in
// which lobes are fitted (docs/math.md, section 21). Experimental.

#include "prt/bake/level_bake.h"
#include "prt/core/progress.h"
#include "prt/gltf/animation.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// The world matrices of all nodes at one time.
struct ModelPose {
    std::string animation;         ///< name of the animation; empty: the pose in the file
    double seconds = 0;            ///< seconds since the beginning of the animation
    std::vector<glm::dmat4> nodes; ///< [AnimatedScene::nodes()] world matrices
};

/// Returns 1 + `count` poses: the pose of the file, then `count` poses at the centers of equal intervals of
/// the total time of the animations, one animation after another. `only`: name of the animations to use;
/// empty: all. Throws `Error` if the model has no animation or no animation with this name, and for a count
/// below 1.
std::vector<ModelPose> poses_of(const AnimatedScene& model, int count, const std::string& only = {});

/// Returns `count` poses at the beginnings of equal intervals of the total time of the animations, one
/// animation after another. For one animation of two seconds, 6 poses are at 0, 1/3, 2/3, .. 5/3 s. `only`:
/// name of the animations to use; empty: all. Throws `Error` if the model has no animation or no animation
/// with this name, and for a count below 1.
std::vector<ModelPose> frames_of(const AnimatedScene& model, int count, const std::string& only = {});

/// Returns whether the vertices of each array move or can move, [Scene::vertex_arrays]: with a skin, with
/// morph targets, or because their node has different matrices in `poses`.
std::vector<bool> moving_arrays(const AnimatedScene& model, std::span<const ModelPose> poses);

/// Returns the nodes of AnimatedScene::leveled with the levels that move or can move (`moving_arrays`).
std::vector<LeveledNode> moving_levels(const AnimatedScene& model, std::span<const ModelPose> poses);

/// Settings of the bake of each pose.
struct PoseBakeOptions {
    int order = 4;   ///< order of the transfer, 1..kMaxOrder
    int rays = 256;  ///< number of rays per vertex and pose, 1..kMaxRays
    int bounces = 1; ///< number of bounces, 0..kMaxBounces, or kEndlessBounces
    /// Target error of each pose, which replaces `rays`, as in BakeOptions::target_error.
    std::optional<double> target_error = {};
    TracerChoice tracer =
        {}; ///< hardware and method that trace the rays; a distance fall-off needs 0 bounces
    BadTextures bad_textures = BadTextures::error; ///< treatment of missing and damaged textures
    int threads = 0;                               ///< number of threads; 0: all
    std::uint64_t seed = 0;                        ///< seed of the random directions of rays
    LevelMode levels = LevelMode::carry;           ///< transfer of moving coarser levels in `mean_of_poses`
    /// Model with the same skeleton that acts as FinerModel in each pose, and its reach; may be null. It
    /// follows the model by the names of nodes (AnimatedScene::followed).
    const AnimatedScene* high_poly = nullptr;
    double reach = 0;
};
/// Returns the options of the bake of a pose.
BakeOptions bake_options_of(const PoseBakeOptions& options);

/// Returns the model in `pose` with the levels of `nodes`, which are nodes of AnimatedScene::leveled,
/// relative to Scene::origin of the model. Throws `Error` if a coordinate of a vertex exceeds
/// kFarthestVertex.
LeveledScene scene_in_pose(const AnimatedScene& model, const ModelPose& pose, std::vector<LeveledNode> nodes);

/// Transfer of the model in one pose, without surroundings and without lamps. Vertices are the receivers of
/// AnimatedScene::scene().
struct PoseTransfer {
    /// [vertices] transfer with a single `combined` term that has one channel or three, in world space.
    /// Sealed vertices have the transfer of their neighbours, see Inside::refill.
    Transfer transfer;        ///< 0 in coarser levels that are not baked
    std::vector<float> areas; ///< [vertices] area in this pose, m²; 0 for sealed vertices
    std::vector<bool> sealed; ///< [vertices] true: the vertex is inside solid geometry and never visible
    std::size_t rays = 0;     ///< number of all traced rays
    int rays_per_vertex = 0;  ///< BakeRecord::rays
    std::vector<std::string> notices; ///< BakeStatistics::notices
};
/// Bakes the transfer of level 0 of the model in `pose`. Throws the errors of `scene_in_pose`,
/// `bake` and AnimatedScene::followed.
PoseTransfer bake_pose(const AnimatedScene& model, const ModelPose& pose, const PoseBakeOptions& options,
                       const Progress& progress = {});

/// Transforms transfer between world space in a pose and the frame of each vertex, in which the mesh stores
/// the vertex normal. The rotation between both is the rotation nearest to the vertex matrix (its polar
/// factor), or the identity if the matrix is nearly singular. If the matrix mirrors, the rotation is nearest
/// to the negative matrix, and directions are also negated.
class VertexFrames {
public:
    /// Computes the frames of all vertices of `model` in `pose`. Keeps no reference to the arguments.
    VertexFrames(const AnimatedScene& model, const ModelPose& pose);
    /// Returns the number of vertices of the model.
    std::size_t vertices() const { return matrices_.size(); }
    /// Returns the linear part of the matrix from `vertex` to the world (`vertex_matrix`), including scale
    /// and shear.
    const glm::dmat3& matrix(std::size_t vertex) const { return matrices_[vertex]; }
    /// Transforms transfer vector `in` with one channel, [order²], from the frame of `vertex` to world space,
    /// and writes it to `out` [order²]. `out` may be `in`.
    void to_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;
    /// Transforms transfer vector `in` with one channel, [order²], from world space to the frame of `vertex`,
    /// and writes it to `out` [order²]. `out` may be `in`.
    void from_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;

private:
    std::vector<glm::dmat3> matrices_;  ///< linear parts of the vertices' matrices
    std::vector<glm::dmat3> rotations_; ///< rotations, with determinant 1
    std::vector<bool> mirrored_;        ///< mirrored vertices: w becomes -w after the rotation
};

/// Transfer with one channel in the frames of the vertices: the mean over the color channels and over poses.
struct MeanTransfer {
    int order = 0; ///< order of the transfer
    /// [vertices][order²] mean over the poses in which the vertex is not sealed; over all poses if it is
    /// sealed in all.
    std::vector<double> vectors;
    /// [vertices][order²] transfer in the first pose, also of vertices that are sealed in this pose.
    std::vector<double> rest;
    /// [vertices] m²: mean area over the poses, in which a sealed vertex has the area 0. A vertex that is
    /// sealed in all poses has a hundredth of its area in the pose of the file.
    std::vector<float> areas;
    std::size_t rays = 0;    ///< number of all traced rays
    int rays_per_vertex = 0; ///< mean of PoseTransfer::rays_per_vertex
    /// Number of vertices that are sealed in all poses; they have the transfer of their neighbours.
    std::size_t hidden = 0;
    std::vector<std::string> notices; ///< notices of the first pose
    LevelBake levels; ///< moving coarser levels in the first pose, without `transfer`; `seconds`: all poses

    /// Returns the number of coefficients of a transfer vector, order².
    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    /// Returns the number of vertices of the model.
    std::size_t vertices() const { return areas.size(); }
};

/// Bakes all `poses` (at least one) and averages their transfer in the vertex frames. Pose i uses the seed
/// `seed` + i of `options`. Poses in which a vertex is sealed (inside solid geometry) do not count for this
/// vertex, unless it is sealed in all. A fit to the mean is a fit to all poses that count: in the vertex
/// frames, the sum of squared differences to their vectors is the squared difference to their mean, times the
/// number of these poses, plus a constant. Moving levels of detail get transfer in each pose, as
/// PoseBakeOptions::levels requests. Throws the errors of `bake_pose` and `transfer_of_levels`.
MeanTransfer mean_of_poses(const AnimatedScene& model, std::span<const ModelPose> poses,
                           const PoseBakeOptions& options, const Progress& progress = {});

/// Writes the mean over the color channels of the transfer vector of `receiver` to `grey` [order²].
/// `transfer` must have a single term of the kind `combined`, with one channel or three.
void grey_vector(const Transfer& transfer, std::size_t receiver, std::span<double> grey);

} // namespace prt
