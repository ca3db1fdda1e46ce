#pragma once

// Transfer of a model that moves: baked in poses, and seen from the frames of its vertices, in which lobes
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
    std::string animation; ///< its name; empty: the model as its file stands
    double seconds = 0;
    std::vector<glm::dmat4> nodes;
};

/// As the file stands, then `count` poses, evenly over one animation behind the other, in the middles of
/// equal spans of time. `only`: the name of the one to take; empty: all. Throws `Error` where there is none,
/// and for a count below 1.
std::vector<ModelPose> poses_of(const AnimatedScene& model, int count, const std::string& only = {});

/// `count` poses from the beginning on, so many of one animation after the other, without that of the file:
/// of one animation of two seconds 6 poses are every tenth of its 60 frames.
std::vector<ModelPose> frames_of(const AnimatedScene& model, int count, const std::string& only = {});

struct PoseBakeOptions {
    int order = 4;
    int rays = 256; ///< of a vertex in a pose
    int bounces = 1;
    TracerChoice tracer = {};
    BadTextures bad_textures = BadTextures::error;
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
};

/// The self-transfer of one pose: light from everywhere around the model alone.
struct PoseTransfer {
    Transfer transfer;        ///< `whole`, of one channel or three, in the world
    std::vector<float> areas; ///< m²; 0 of vertices that are sealed in: nobody sees them
    std::vector<bool> sealed;
    std::size_t rays = 0;
};
PoseTransfer bake_pose(const AnimatedScene& model, const ModelPose& pose, const PoseBakeOptions& options,
                       const Progress& progress = {});

/// Between the world in a pose and the frame of the normals of each vertex: by the rotation that is next to
/// its matrix (its polar factor). What mirrors, mirrors.
class VertexFrames {
public:
    VertexFrames(const AnimatedScene& model, const ModelPose& pose);
    std::size_t vertices() const { return matrices_.size(); }
    const glm::dmat3& matrix(std::size_t vertex) const { return matrices_[vertex]; }
    /// Grey transfer vectors [order²], `out` may be `in`.
    void to_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;
    void from_world(int order, std::size_t vertex, std::span<const double> in, std::span<double> out) const;

private:
    std::vector<glm::dmat3> matrices_;  ///< linear parts of the vertices' matrices
    std::vector<glm::dmat3> rotations_; ///< of determinant 1
    std::vector<bool> mirrored_;        ///< behind the rotation, w becomes -w
};

/// Grey transfer of many poses in the frames of the vertices, mean channel by channel.
struct MeanTransfer {
    int order = 0;
    std::vector<double> vectors; ///< [vertices][order²]: the mean over the poses
    std::vector<double> rest;    ///< the same of the first pose alone
    /// m², the mean over the poses; of vertices that all poses hide, a hundredth of what they would have.
    std::vector<float> areas;
    std::size_t rays = 0;
    std::size_t hidden = 0; ///< vertices that every pose seals in: they have the light of their neighbours

    std::size_t coefficients() const { return static_cast<std::size_t>(order * order); }
    std::size_t vertices() const { return areas.size(); }
};

/// A pose counts at a vertex unless the vertex is sealed in. Over turning frames the sum of squared
/// differences of one vector to those of all poses is that to their mean, and a constant: whatever is fitted
/// to the mean is fitted to all poses at once.
MeanTransfer mean_of_poses(const AnimatedScene& model, std::span<const ModelPose> poses,
                           const PoseBakeOptions& options, const Progress& progress = {});

/// The mean over the channels of a `whole` vector.
void grey_vector(const Transfer& transfer, std::size_t receiver, std::span<double> grey);

} // namespace prt
