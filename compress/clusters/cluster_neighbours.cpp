#include "clusters/cluster_neighbours.h"

#include "prt/support/parallel.h"

#include <algorithm>
#include <utility>

namespace prt {

MeanDistances::MeanDistances(std::size_t clusters, std::size_t dimension,
                             const std::function<const float*(std::size_t)>& mean)
    : means_(static_cast<Eigen::Index>(clusters), static_cast<Eigen::Index>(dimension)) {
    for (std::size_t k = 0; k < clusters; ++k)
        for (std::size_t i = 0; i < dimension; ++i)
            means_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = mean(k)[i];
}

Eigen::ArrayXf MeanDistances::from(std::size_t cluster) const {
    Eigen::ArrayXf squared = Eigen::ArrayXf::Zero(means_.rows());
    for (Eigen::Index i = 0; i < means_.cols(); ++i)
        squared += (means_.col(i) - means_(static_cast<Eigen::Index>(cluster), i)).square();
    return squared;
}

std::vector<std::vector<std::uint32_t>>
nearest_clusters(const MeanDistances& means, std::size_t most, int threads,
                 const std::function<float(std::size_t k, std::size_t other)>& distance) {
    const std::size_t count = means.clusters();
    std::vector<std::vector<std::uint32_t>> result(count);
    parallel_for(count, 8, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<float, std::uint32_t>> near;
        const auto keep_nearest = [&](std::size_t kept) {
            const auto last = near.begin() + static_cast<std::ptrdiff_t>(std::min(kept, near.size()));
            std::partial_sort(near.begin(), last, near.end());
            near.erase(last, near.end());
        };
        for (std::size_t k = begin; k < end; ++k) {
            const Eigen::ArrayXf squared = means.from(k);
            near.clear();
            for (std::uint32_t other = 0; other < count; ++other)
                near.emplace_back(other == k ? -1.0f : squared[static_cast<Eigen::Index>(other)], other);
            keep_nearest(4 * most);
            for (auto& [d, other] : near)
                if (other != k)
                    d = distance(k, other);
            keep_nearest(most);
            for (const auto& [d, other] : near)
                result[k].push_back(other);
        }
    });
    return result;
}

} // namespace prt
