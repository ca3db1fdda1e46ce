#pragma once

#include "prt/core/clustered_transfer.h"

#include <span>
#include <vector>

namespace prt::pipeline {

/// Contribution of one cluster, over all lights of an evaluation.
struct ClusterShare {
    std::size_t cluster = 0, receivers = 0;
    int components = 0;
    double area_share = 0;  ///< fraction of the total area
    double error_share = 0; ///< fraction of the total squared error
    double lit_rms = 0;     ///< relative RMS error of its receivers
};

/// Sums the contribution of each cluster, light by light.
class ClusterShares {
public:
    explicit ClusterShares(std::size_t clusters) : shares_(clusters), norms_(clusters, 0) {}

    void add(std::span<const std::uint16_t> clusters, std::span<const float> areas,
             std::span<const glm::vec3> reference, std::span<const glm::vec3> shipped);
    /// The worst first.
    std::vector<ClusterShare> finish(const ClusteredTransfer& transfer, std::span<const float> areas);

private:
    std::vector<ClusterShare> shares_;
    std::vector<double> norms_;
};

} // namespace prt::pipeline
