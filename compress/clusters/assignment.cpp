// Assigns points to the clusters with minimum loss: the step of Lloyd's iteration, with the distance to an
// affine subspace instead of a mean (Sloan et al. 2003), for blocks of points in SIMD registers.

#include "compress/clusters/assignment.h"

#include <numeric>

namespace prt {
namespace {

/// Returns the squared length of the residual `d` outside of the directions: |d|² - |B d|² (docs/math.md, eq.
/// 23). In float it loses precision below 1e-6 |d|², which is sufficient to choose between clusters.
template <class Value>
[[gnu::always_inline]] inline Value squared_outside(const Value* d, std::size_t dimension,
                                                    const float* directions, std::size_t components) {
    Value total = {};
    for (std::size_t i = 0; i < dimension; ++i)
        total += d[i] * d[i];
    std::size_t j = 0;
    for (; j + 4 <= components; j += 4) { // four at a time hide the latency of the sums
        const float* b = directions + j * dimension;
        Value p0 = {}, p1 = {}, p2 = {}, p3 = {};
        for (std::size_t i = 0; i < dimension; ++i) {
            p0 += b[i] * d[i];
            p1 += b[dimension + i] * d[i];
            p2 += b[2 * dimension + i] * d[i];
            p3 += b[3 * dimension + i] * d[i];
        }
        total -= p0 * p0 + p1 * p1 + (p2 * p2 + p3 * p3);
    }
    for (; j < components; ++j) {
        const float* b = directions + j * dimension;
        Value p = {};
        for (std::size_t i = 0; i < dimension; ++i)
            p += b[i] * d[i];
        total -= p * p;
    }
    return total;
}

template <int Width>
[[gnu::always_inline]] inline void nearest_of(const float* block, const PenalisedClusters& clusters,
                                              std::span<const std::uint32_t> candidates,
                                              std::uint32_t* nearest, float* errors) {
    const auto distance = [&](std::uint32_t k) __attribute__((always_inline)) {
        typename Floats<Width>::Value left[kMaxDimensions];
        known_subtracted<Width>(block, clusters.dimension, clusters.mean(k), clusters.center(k),
                                clusters.slope(k, 0), clusters.predictors, left);
        return squared_outside(left, clusters.dimension, clusters.row(k, 0), clusters.components_of(k)) +
               clusters.penalties[k];
    };
    keep_nearest<Width>(candidates, nearest, errors, distance);
}

PRT_WIDE_TARGET
void nearest_at_once(const float* block, const PenalisedClusters& clusters,
                     std::span<const std::uint32_t> candidates, std::uint32_t* nearest, float* errors) {
    nearest_of<kLaneCount>(block, clusters, candidates, nearest, errors);
}

PRT_TWO_CLONES
void nearest_by_parts(const float* block, const PenalisedClusters& clusters,
                      std::span<const std::uint32_t> candidates, std::uint32_t* nearest, float* errors) {
    for (int first = 0; first < kLaneCount; first += kNarrow)
        nearest_of<kNarrow>(points_from(block, first), clusters, candidates, nearest + first, errors + first);
}

void nearest_of_block(const float* block, const PenalisedClusters& clusters,
                      std::span<const std::uint32_t> candidates, std::uint32_t* nearest, float* errors) {
    (has_wide_registers() ? nearest_at_once : nearest_by_parts)(block, clusters, candidates, nearest, errors);
}

PRT_TARGET_CLONES
void distances_of_block(const float* block, std::size_t dimension, const float* center, float* distances) {
    Lanes distance = {};
    for (std::size_t i = 0; i < dimension; ++i) {
        const Lanes d = lanes_at(block + i * kLanes) - center[i];
        distance += d * d;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        distances[lane] = distance[lane];
}

} // namespace

Assignment assign(const PointBlocks& points, const PenalisedClusters& clusters, int threads) {
    std::vector<std::uint32_t> all(clusters.clusters());
    std::iota(all.begin(), all.end(), 0u);
    Assignment result{std::vector<std::uint32_t>(points.count), std::vector<float>(points.count)};
    parallel_for(points.blocks(), 32, threads, [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<std::uint32_t, kLanes> nearest{};
        alignas(64) std::array<float, kLanes> errors{};
        std::vector<float> room(points.width() * kLanes);
        for (std::size_t b = begin; b < end; ++b) {
            nearest_of_block(points.block(b, room.data()), clusters, all, nearest.data(), errors.data());
            const std::size_t first = b * kLanes, n = std::min(kLanes, points.count - first);
            std::copy_n(nearest.begin(), n, &result.clusters[first]);
            std::transform(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(n),
                           &result.errors[first], [](float e) { return std::max(e, 0.0f); });
        }
    });
    return result;
}

std::vector<std::uint32_t> reassign(const PointBlocks& points, const PenalisedClusters& clusters,
                                    const ClusterLists& candidates, std::span<const std::uint32_t> now,
                                    int threads) {
    return reassign_members(points, candidates, now, threads,
                            [&](const MemberBlock&, const float* block, std::span<const std::uint32_t> near,
                                std::uint32_t* nearest,
                                float* errors) { nearest_of_block(block, clusters, near, nearest, errors); });
}

void lower_to_distance(const PointBlocks& points, const float* center, std::span<float> errors, int threads) {
    parallel_for(points.blocks(), 256, threads, [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<float, kLanes> distances{};
        std::vector<float> room(points.width() * kLanes);
        for (std::size_t b = begin; b < end; ++b) {
            distances_of_block(points.block(b, room.data()), points.dimension, center, distances.data());
            for (std::size_t p = b * kLanes; p < std::min((b + 1) * kLanes, points.count); ++p)
                errors[p] = std::min(errors[p], distances[p % kLanes]);
        }
    });
}

} // namespace prt
