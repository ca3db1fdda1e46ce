#pragma once

// Factors of an instance by least squares against what its samples get.

#include "prt/instances.h"

#include <Eigen/Dense>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Samples of a mesh: receivers of it, and where they lie in its box.
struct InstanceSamples {
    std::vector<std::uint32_t> receivers;
    std::vector<glm::vec3> places;
};

/// The least-squares problem of the instances of a mesh that see the world's up alike (docs/math.md, section
/// 22). Immutable, thread-safe.
class InstanceFit {
public:
    /// Copies what it needs. `up` as `shared` was made with.
    InstanceFit(const SharedTransfer& shared, const InstanceSamples& samples, const glm::dvec3& up);

    /// Vectors of the samples in the mesh's frame, [samples][dimension], by two independent halves of their
    /// rays; of those that are `left_out` [samples] nothing is asked.
    struct Targets {
        std::span<const float> first, second;
        const std::vector<bool>& left_out;
    };
    struct Fitted {
        InstanceFactors factors; ///< in axes of the mesh
        double error = 0;        ///< as InstanceBake::errors
    };
    Fitted fit(const Targets& targets) const;

private:
    std::size_t rows_of_sample() const { return static_cast<std::size_t>(weights_.size()); }
    double error(const Targets& targets, const Eigen::VectorXd& solution) const;

    bool added_ = false; ///< there is a part for it
    int channels_ = 1;   ///< of that part
    std::size_t samples_ = 0;
    Eigen::VectorXf weights_; ///< [dimension] of the metric
    Eigen::MatrixXf columns_; ///< [samples · dimension][unknowns], weighted
    Eigen::MatrixXd normal_;
    Eigen::VectorXd open_;  ///< the unknowns of open_factors()
    Eigen::MatrixXf skies_; ///< [dimension][skies · colors]: light of the five skies, over the weights
};

} // namespace prt
