#pragma once

// Fits the factors of an instance to its samples by least squares.

#include "bake/products/instances/uniform_bound.h"
#include "prt/core/instances.h"

#include <Eigen/Dense>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Samples of a mesh: receivers, their positions in the mesh's box, and the areas that they represent, with
/// mean 1.
struct InstanceSamples {
    std::vector<std::uint32_t> receivers;
    std::vector<glm::vec3> positions;
    std::vector<float> areas;
};

/// Every `kSamplesToOfNoise`-th sample is traced twice to estimate the noise.
inline constexpr std::size_t kSamplesToOfNoise = 8;

/// The least-squares problem for instances of a mesh for which the world's up direction is the same in the
/// mesh's frame (docs/math.md, section 22). Immutable and thread-safe.
class InstanceFit {
public:
    /// Copies the required data. `up` is the one that `shared` was created with.
    InstanceFit(const SharedTransfer& shared, const InstanceSamples& samples, const glm::dvec3& up);

    /// Light of an instance's samples, in the mesh's frame.
    struct Targets {
        std::span<const float> light;      ///< [samples][dimension]
        const std::vector<bool>& left_out; ///< [samples] samples that are ignored
    };
    /// Fits factors in axes of the mesh. If there is a `bound`, the factors satisfy it.
    InstanceFactors fit(const Targets& targets, const UniformBound* bound = nullptr) const;

    /// Differences of repeated traces divided by √2: their mean square is the noise variance. [some of the
    /// samples][dimension]
    struct Noise {
        std::span<const float> differences;
        std::size_t first; ///< sample of the first difference; the others follow in steps of
                           ///< kSamplesToOfNoise
    };
    /// Error as in InstanceBake::errors, for factors and `lights` in axes of the mesh. `shared` is the one of
    /// the constructor.
    double error(const SharedTransfer& shared, const Targets& targets, const Noise& noise,
                 const InstanceFactors& factors, std::span<const Lighting> lights = {}) const;

private:
    Eigen::Index dimension() const { return weights_.size(); }
    Eigen::MatrixXf columns_of(const SharedTransfer& shared, std::size_t sample) const;
    Eigen::VectorXd unknowns_of(const InstanceFactors& factors) const;
    InstanceFactors factors_of_unknowns(const Eigen::VectorXd& unknowns) const;

    TransferLayout layout_;
    bool added_ = false; ///< there is a term for added modes
    int channels_ = 1;   ///< channels of that term
    InstanceSamples samples_;
    Eigen::VectorXf weights_; ///< [dimension] squared weights of the metric
    // A column of a passing mode is the mode times a coordinate of the position; a column of an added mode is
    // the light on level ground times a response.
    Eigen::MatrixXf modes_; ///< [dimension][samples · passing modes] weighted, also by area
    Eigen::MatrixXf level_; ///< [dimension][channels] weighted
    std::vector<std::array<glm::vec3, kInstanceLampFunctions>> responses_; ///< [samples]
    std::vector<Eigen::MatrixXf> normals_;                                 ///< [samples]
    Eigen::MatrixXd normal_;                                               ///< sum of `normals_`
    Eigen::VectorXd open_;                                                 ///< unknowns of open_factors()
    Eigen::MatrixXf skies_; ///< [dimension][soft skies · colors]
};

} // namespace prt
