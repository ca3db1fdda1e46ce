#pragma once

#include "prt/clustered_transfer.h"

#include <span>
#include <vector>

namespace prt::cli {

/// What one cluster contributes, over all lights of an evaluation.
struct ClusterShare {
    std::size_t cluster = 0, receivers = 0;
    int components = 0;
    double area_share = 0;  ///< of all area
    double error_share = 0; ///< of the squared error
    double lit_rms = 0;     ///< of its receivers alone
};

/// Sums what each cluster contributes, light by light.
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

} // namespace prt::cli
