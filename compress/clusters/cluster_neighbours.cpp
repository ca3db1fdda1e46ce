// Finds for every cluster those that its points may move to, so that a round need not try all.

#include "compress/clusters/cluster_neighbours.h"

#include "compress/tuning/tuning.h"

#include <utility>

namespace prt {
namespace {

/// Returns the squared distance from cluster k's mean to the points of `other`: the distance to its mean,
/// reduced by the extent of its rows.
float squared_gap(const AffineClusters& clusters, std::span<const RowReach> reaches, std::size_t k,
                  std::size_t other) {
    const std::size_t dimension = clusters.dimension;
    std::array<float, kMaxDimensions> d;
    for (std::size_t i = 0; i < dimension; ++i)
        d[i] = clusters.mean(k)[i] - clusters.mean(other)[i];
    for (std::size_t j = 0; j < clusters.components_of(other); ++j) {
        const float* row = clusters.row(other, j);
        const RowReach& reach = reaches[other * clusters.max_components + j];
        float w = 0;
        for (std::size_t i = 0; i < dimension; ++i)
            w += row[i] * d[i];
        w = std::clamp(w * reach.inverse_norm, -reach.max_weight, reach.max_weight);
        for (std::size_t i = 0; i < dimension; ++i)
            d[i] -= w * row[i];
    }
    float squared = 0;
    for (std::size_t i = 0; i < dimension; ++i)
        squared += d[i] * d[i];
    return squared;
}

} // namespace

MeanDistances::MeanDistances(const AffineClusters& clusters)
    : means_(static_cast<Eigen::Index>(clusters.clusters()), static_cast<Eigen::Index>(clusters.dimension)) {
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        for (std::size_t i = 0; i < clusters.dimension; ++i)
            means_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = clusters.mean(k)[i];
}

Eigen::ArrayXf MeanDistances::from(std::size_t cluster) const {
    Eigen::ArrayXf squared = Eigen::ArrayXf::Zero(means_.rows());
    for (Eigen::Index i = 0; i < means_.cols(); ++i)
        squared += (means_.col(i) - means_(static_cast<Eigen::Index>(cluster), i)).square();
    return squared;
}

ClusterLists neighbour_clusters(const AffineClusters& clusters, std::span<const RowReach> reaches,
                                std::size_t most, int threads) {
    const MeanDistances means(clusters);
    ClusterLists result(clusters.clusters());
    parallel_for(result.size(), 8, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<float, std::uint32_t>> near;
        const auto keep_nearest_of_them = [&](std::size_t kept) {
            const auto last = near.begin() + static_cast<std::ptrdiff_t>(std::min(kept, near.size()));
            std::partial_sort(near.begin(), last, near.end());
            near.erase(last, near.end());
        };
        for (std::size_t k = begin; k < end; ++k) {
            const Eigen::ArrayXf squared = means.from(k);
            near.clear();
            for (std::uint32_t other = 0; other < result.size(); ++other)
                near.emplace_back(other == k ? -1.0f : squared[static_cast<Eigen::Index>(other)], other);
            keep_nearest_of_them(tuning::kMeansPerNeighbour * most);
            for (auto& [d, other] : near)
                if (other != k)
                    d = squared_gap(clusters, reaches, k, other);
            keep_nearest_of_them(most);
            for (const auto& [d, other] : near)
                result[k].push_back(other);
        }
    });
    return result;
}

} // namespace prt
