#pragma once

// Transfer of an animated model: baked in poses and expressed in the frames of its vertices, in which lobes
// are fitted (docs/math.md, section 21). Experimental.

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

/// Returns the pose of the file and `count` poses, evenly spaced over all animations one after another, in
/// the middle of equal time intervals. `only`: name of the animation to use; empty: all. Throws `Error` if
/// there is no such animation, and for a count below 1.
std::vector<ModelPose> poses_of(const AnimatedScene& model, int count, const std::string& only = {});

/// Returns `count` poses without the pose of the file, evenly spaced over all animations one after another,
/// starting at the beginning. For one animation of two seconds, 6 poses are every tenth of its 60 frames.
/// Arguments and errors are those of `poses_of`.
std::vector<ModelPose> frames_of(const AnimatedScene& model, int count, const std::string& only = {});

struct PoseBakeOptions {
    int order = 4;
    int rays = 256; ///< rays per vertex and pose
    int bounces = 1;
    TracerChoice tracer = {};
    BadTextures bad_textures = BadTextures::error;
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Self-transfer of one pose: the model alone, lit from all directions.
struct PoseTransfer {
    Transfer transfer;        ///< `combined` transfer with one channel or three, in world space
    std::vector<float> areas; ///< m²; 0 for vertices that are sealed in, which nobody sees
    std::vector<bool> sealed;
    std::size_t rays = 0;
};
/// Bakes the self-transfer of `pose`. Throws `Error` for vertices that are too far away, and the errors of
/// `bake`.
PoseTransfer bake_pose(const AnimatedScene& model, const ModelPose& pose, const PoseBakeOptions& options,
                       const Progress& progress = {});

/// Transforms between world space in a pose and the frame of each vertex's normal. The rotation is the one
/// nearest to the vertex matrix (its polar factor). A matrix that mirrors is mirrored here, too.
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

/// Grey transfer of many poses in the frames of the vertices: the mean over poses and channels.
struct MeanTransfer {
    int order = 0;
    std::vector<double> vectors; ///< [vertices][order²] mean over the poses
    std::vector<double> rest;    ///< [vertices][order²] vectors of the first pose
    /// m², mean over the poses; for vertices that all poses hide, a hundredth of their area.
    std::vector<float> areas;
    std::size_t rays = 0;
    std::size_t hidden = 0; ///< vertices that every pose seals in; they take the light of their neighbours

    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    std::size_t vertices() const { return areas.size(); }
};

/// Averages the poses in the vertex frames. A pose counts at a vertex unless the vertex is sealed in. In
/// rotating frames the sum of squared differences between one vector and those of all poses equals the
/// squared difference to their mean plus a constant, so that a fit to the mean is a fit to all poses.
MeanTransfer mean_of_poses(const AnimatedScene& model, std::span<const ModelPose> poses,
                           const PoseBakeOptions& options, const Progress& progress = {});

/// Writes the mean over the channels of a `combined` vector to `grey`.
void grey_vector(const Transfer& transfer, std::size_t receiver, std::span<double> grey);

} // namespace prt
