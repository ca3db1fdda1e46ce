#pragma once

// Factors of an instance by least squares against what its samples get.

#include "instances/uniform_bound.h"
#include "prt/instances.h"

#include <Eigen/Dense>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Samples of a mesh: receivers of it, where they lie in its box, and the area that each stands for, 1 in the
/// mean.
struct InstanceSamples {
    std::vector<std::uint32_t> receivers;
    std::vector<glm::vec3> places;
    std::vector<float> areas;
};

/// Of every so many samples, by their number among those of all instances, one tells the noise of its rays.
inline constexpr std::size_t kSamplesToOfNoise = 8;

/// The least-squares problem of the instances of a mesh that see the world's up alike (docs/math.md, section
/// 22). Immutable, thread-safe.
class InstanceFit {
public:
    /// Copies what it needs. `up` as `shared` was made with.
    InstanceFit(const SharedTransfer& shared, const InstanceSamples& samples, const glm::dvec3& up);

    /// What the samples of an instance get, in the mesh's frame.
    struct Targets {
        std::span<const float> light;      ///< [samples][dimension]
        const std::vector<bool>& left_out; ///< [samples] of which nothing is asked
    };
    /// Factors in axes of the mesh, which keep to `bound`, where there is one.
    InstanceFactors fit(const Targets& targets, const UniformBound* bound = nullptr) const;

    /// What as many other rays of every so many samples give otherwise, over the root of 2, so that its
    /// square is that of the noise on average: [some of the samples][dimension].
    struct Noise {
        std::span<const float> differences;
        std::size_t first; ///< the sample of the first; those of the others follow, kSamplesToOfNoise apart
    };
    /// As InstanceBake::errors, for factors and `lights` in axes of the mesh. `shared` as in the constructor.
    double error(const SharedTransfer& shared, const Targets& targets, const Noise& noise,
                 const InstanceFactors& factors, std::span<const Lighting> lights = {}) const;

private:
    Eigen::Index dimension() const { return weights_.size(); }
    Eigen::MatrixXf columns_of(const SharedTransfer& shared, std::size_t sample) const;
    Eigen::VectorXd unknowns_of(const InstanceFactors& factors) const;
    InstanceFactors factors_of_unknowns(const Eigen::VectorXd& unknowns) const;

    TransferLayout layout_;
    bool added_ = false; ///< there is a part for it
    int channels_ = 1;   ///< of that part
    InstanceSamples samples_;
    Eigen::VectorXf weights_; ///< [dimension] of the metric, squared
    // Columns of a passing mode are the mode times a place's numbers, those of an added one the level times a
    // response's.
    Eigen::MatrixXf modes_; ///< [dimension][samples · passing modes]: weighted, by area too
    Eigen::MatrixXf level_; ///< [dimension][channels]: weighted
    std::vector<std::array<glm::vec3, kAddedModes>> responses_; ///< [samples]
    std::vector<Eigen::MatrixXf> normals_;                      ///< [samples]
    Eigen::MatrixXd normal_;                                    ///< their sum
    Eigen::VectorXd open_;                                      ///< the unknowns of open_factors()
    Eigen::MatrixXf skies_;                                     ///< [dimension][soft skies · colors]
};

} // namespace prt
