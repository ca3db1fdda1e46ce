#pragma once

// Transfer of an animated model: baked in several poses, then transformed to the frames of its vertices, in
// which lobes are fitted (docs/math.md, section 21). Experimental.

#include "prt/animation.h"
#include "prt/bake.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// The world matrices of all nodes at one time.
struct ModelPose {
    std::string animation; ///< name of the animation; empty: the pose in the file
    double seconds = 0;
    std::vector<glm::dmat4> nodes;
};

/// Returns 1 + `count` poses: the pose of the file, then `count` poses at the centers of equal time intervals
/// over all animations, one animation after another. `only`: name of the animation to use; empty: all. Throws
/// `Error` if there is no such animation, and for a count below 1.
std::vector<ModelPose> poses_of(const AnimatedScene& model, int count, const std::string& only = {});

/// Returns `count` poses at the beginnings of equal time intervals over all animations, one animation after
/// another. For one animation of two seconds, 6 poses are at 0, 1/3, 2/3, .. 5/3 s. Arguments and errors
/// are those of `poses_of`.
std::vector<ModelPose> frames_of(const AnimatedScene& model, int count, const std::string& only = {});

/// Settings for each pose.
struct PoseBakeOptions {
    int order = 4;
    int rays = 256; ///< rays per vertex and pose
    int bounces = 1;
    TracerChoice tracer = {};
    BadTextures bad_textures = BadTextures::error;
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Transfer of the model in one pose, without surroundings.
struct PoseTransfer {
    Transfer transfer;        ///< `combined` transfer with one channel or three, in world space
    std::vector<float> areas; ///< m²; 0 for sealed vertices, which are never visible
    std::vector<bool> sealed; ///< [vertices] whether the vertex is inside geometry
    std::size_t rays = 0;
};
/// Bakes the transfer of the model in `pose`. Throws `Error` for vertices beyond kFarthestVertex, and the
/// errors of `bake`.
PoseTransfer bake_pose(const AnimatedScene& model, const ModelPose& pose, const PoseBakeOptions& options,
                       const Progress& progress = {});

/// Transforms transfer between world space in a pose and the frame of each vertex, in which the mesh stores
/// its normal. The frame is rotated by the rotation nearest to the vertex matrix (its polar factor), and is
/// mirrored if the matrix mirrors.
class VertexFrames {
public:
    VertexFrames(const AnimatedScene& model, const ModelPose& pose);
    std::size_t vertices() const { return matrices_.size(); }
    const glm::dmat3& matrix(std::size_t vertex) const { return matrices_[vertex]; }
    /// Transforms a grey transfer vector [order²] of the vertex frame to world space; `out` may be `in`.
    void to_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;
    /// Transforms a grey transfer vector [order²] of world space to the vertex frame; `out` may be `in`.
    void from_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;

private:
    std::vector<glm::dmat3> matrices_;  ///< linear parts of the vertices' matrices
    std::vector<glm::dmat3> rotations_; ///< rotations, with determinant 1
    std::vector<bool> mirrored_;        ///< mirrored vertices: w becomes -w after the rotation
};

/// Grey transfer in the frames of the vertices: the mean over poses and channels.
struct MeanTransfer {
    int order = 0;
    std::vector<double> vectors; ///< [vertices][order²] mean over the poses
    std::vector<double> rest;    ///< [vertices][order²] vectors of the first pose
    /// m², mean over the poses; for vertices that are sealed in all poses, a hundredth of their area.
    std::vector<float> areas;
    std::size_t rays = 0;
    /// Vertices that are sealed in all poses; they take the transfer of their neighbours.
    std::size_t hidden = 0;

    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    std::size_t vertices() const { return areas.size(); }
};

/// Bakes all poses and averages their transfer in the vertex frames. Poses in which a vertex is sealed do not
/// count for it. A fit to this mean is a fit to all poses, because in the vertex frames the sum of squared
/// differences to the vectors of all poses is the squared difference to their mean plus a constant.
MeanTransfer mean_of_poses(const AnimatedScene& model, std::span<const ModelPose> poses,
                           const PoseBakeOptions& options, const Progress& progress = {});

/// Writes the mean over the channels of `receiver`'s vector to `grey` [order²]. `transfer` has a single
/// `combined` term.
void grey_vector(const Transfer& transfer, std::size_t receiver, std::span<double> grey);

} // namespace prt
