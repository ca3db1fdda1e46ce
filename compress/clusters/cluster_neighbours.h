#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace prt {

/// Squared distances between the means of clusters, one against all others at once.
class MeanDistances {
public:
    /// `mean(k)` points at the `dimension` values of cluster k.
    MeanDistances(std::size_t clusters, std::size_t dimension,
                  const std::function<const float*(std::size_t)>& mean);

    std::size_t clusters() const { return static_cast<std::size_t>(means_.rows()); }
    /// [clusters]
    Eigen::ArrayXf from(std::size_t cluster) const;

private:
    Eigen::ArrayXXf means_; ///< [clusters] of each coordinate side by side
};

/// Clusters that are near each other, for each the `most` nearest, itself first: of four times as many whose
/// means are nearest, since further ones no direction reaches, those with the least `distance(k, other)` of
/// k's mean to the other's subspace.
std::vector<std::vector<std::uint32_t>>
nearest_clusters(const MeanDistances& means, std::size_t most, int threads,
                 const std::function<float(std::size_t k, std::size_t other)>& distance);

} // namespace prt
