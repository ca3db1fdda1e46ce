// Sums area and error of each cluster.

#include "cli/pipeline/cluster_shares.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt::pipeline {

void ClusterShares::add(std::span<const std::uint16_t> clusters, std::span<const float> areas,
                        std::span<const glm::vec3> reference, std::span<const glm::vec3> shipped) {
    for (std::size_t p = 0; p < clusters.size(); ++p) {
        const double a = static_cast<double>(areas[p]);
        const glm::dvec3 r(reference[p]), d = r - glm::dvec3(shipped[p]);
        shares_[clusters[p]].error_share += a * glm::dot(d, d);
        norms_[clusters[p]] += a * glm::dot(r, r);
    }
}

std::vector<ClusterShare> ClusterShares::finish(const ClusteredTransfer& transfer,
                                                std::span<const float> areas) {
    double area = 0, error = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        ClusterShare& share = shares_[transfer.receivers.cluster(p)];
        ++share.receivers;
        share.area_share += static_cast<double>(areas[p]);
        area += static_cast<double>(areas[p]);
    }
    for (const ClusterShare& share : shares_)
        error += share.error_share;
    for (std::size_t k = 0; k < shares_.size(); ++k) {
        ClusterShare& share = shares_[k];
        share.cluster = k;
        share.components = transfer.bases.components[k];
        share.lit_rms = norms_[k] > 0 ? std::sqrt(share.error_share / norms_[k]) : 0;
        share.area_share /= area > 0 ? area : 1;
        share.error_share /= error > 0 ? error : 1;
    }
    std::stable_sort(shares_.begin(), shares_.end(), [](const ClusterShare& a, const ClusterShare& b) {
        return a.error_share > b.error_share;
    });
    return std::move(shares_);
}

} // namespace prt::pipeline
