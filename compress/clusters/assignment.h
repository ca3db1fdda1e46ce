#pragma once

// Assignment of points to clusters.

#include "compress/clusters/affine_clusters.h"
#include "compress/clusters/member_blocks.h"

#include <array>
#include <limits>

namespace prt {

/// Clusters with orthonormal rows and penalties, for the assignment of points.
struct PenalisedClusters : AffineClusters {
    std::vector<float> penalties; ///< [clusters] added to the squared distance of a point

    PenalisedClusters(std::size_t clusters, std::size_t dimensions, std::size_t component_limit,
                      std::size_t predictor_count = 0)
        : AffineClusters(clusters, dimensions, component_limit, predictor_count), penalties(clusters, 0.0f) {}
};

struct Assignment {
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<float> errors;           ///< [points] squared distance to the cluster plus its penalty
};

/// Returns the points of a block starting at `first`; null for points of dimension 0.
[[gnu::always_inline]] inline const float* points_from(const float* block, int first) {
    return block ? block + first : nullptr;
}

/// Subtracts mean and predictor term of a cluster from `Width` points of `block`: `subtract_known` for
/// several points.
template <int Width>
[[gnu::always_inline]] inline void
known_subtracted(const float* block, std::size_t dimension, const float* mean, const float* center,
                 const float* slopes, std::size_t predictors, typename Floats<Width>::Value* left) {
    for (std::size_t i = 0; i < dimension; ++i)
        left[i] = floats_at<Width>(block + i * kLanes) - mean[i];
    for (std::size_t g = 0; g < predictors; ++g) {
        const typename Floats<Width>::Value x =
            floats_at<Width>(block + (dimension + g) * kLanes) - center[g];
        for (std::size_t i = 0; i < dimension; ++i)
            left[i] -= x * slopes[g * dimension + i];
    }
}

using ClusterLists = std::vector<std::vector<std::uint32_t>>; ///< [clusters][..] indices of clusters

/// Assigns each point to the cluster with the nearest subspace, including penalties; the first of equals.
Assignment assign(const PointBlocks& points, const PenalisedClusters& clusters, int threads);

/// Assigns each point to the nearest of the `candidates` of its current cluster: [points] clusters.
std::vector<std::uint32_t> reassign(const PointBlocks& points, const PenalisedClusters& clusters,
                                    const ClusterLists& candidates, std::span<const std::uint32_t> now,
                                    int threads);

/// Lowers `errors` [points] to the squared distance to `center` [dimension] if that is smaller.
void lower_to_distance(const PointBlocks& points, const float* center, std::span<float> errors, int threads);

/// Writes the candidate with the minimum `distance(k)` of each of `Width` points to `clusters` and `errors`
/// [Width]; the first of equals. The definition of distance varies: orthonormal rows are projected on; rows
/// of codes, which are not orthonormal, are subtracted one after another with rounded weights.
template <int Width, class Distance>
[[gnu::always_inline]] inline void keep_nearest(std::span<const std::uint32_t> candidates,
                                                std::uint32_t* clusters, float* errors, Distance&& distance) {
    for (int lane = 0; lane < Width; ++lane)
        errors[lane] = std::numeric_limits<float>::infinity();
    for (const std::uint32_t k : candidates) {
        const typename Floats<Width>::Value squared = distance(k);
        for (int lane = 0; lane < Width; ++lane) {
            const bool nearer = squared[lane] < errors[lane];
            errors[lane] = nearer ? squared[lane] : errors[lane];
            clusters[lane] = nearer ? k : clusters[lane];
        }
    }
}

/// Reassigns points with current clusters `now`: `nearest_of(members, block, candidates, clusters, errors)`
/// chooses among the candidates of their cluster, kLanes points at a time.
template <class NearestOf>
std::vector<std::uint32_t> reassign_members(const PointBlocks& points, const ClusterLists& candidates,
                                            std::span<const std::uint32_t> now, int threads,
                                            NearestOf&& nearest_of) {
    std::vector<std::uint32_t> result(points.count);
    for_member_blocks(points, now, threads, [&](const MemberBlock& members, const float* block) {
        alignas(64) std::array<std::uint32_t, kLanes> clusters{};
        alignas(64) std::array<float, kLanes> errors{};
        nearest_of(members, block, candidates[members.cluster], clusters.data(), errors.data());
        for (std::size_t lane = 0; lane < members.points.size(); ++lane)
            result[members.points[lane]] = clusters[lane];
    });
    return result;
}

} // namespace prt
