#include "clusters/points.h"

#include "prt/support/parallel.h"
#include "prt/support/vector_lanes.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace prt {
namespace {

/// Squared distance of a block's points to an affine subspace: |d|² - |B d|² with d = x - mean (docs/math.md,
/// eq. 13). In float it loses digits below 1e-6 |d|²; it only decides between clusters.
[[gnu::always_inline]] inline Lanes squared_distance(const float* block, std::size_t dimension,
                                                     const float* mean, const float* directions,
                                                     std::size_t components) {
    Lanes d[kMostDimensions];
    Lanes total = {};
    for (std::size_t i = 0; i < dimension; ++i) {
        d[i] = lanes_at(block + i * kLanes) - mean[i];
        total += d[i] * d[i];
    }
    std::size_t j = 0;
    for (; j + 4 <= components; j += 4) { // four at a time hide the latency of the sums
        const float* b = directions + j * dimension;
        Lanes p0 = {}, p1 = {}, p2 = {}, p3 = {};
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
        Lanes p = {};
        for (std::size_t i = 0; i < dimension; ++i)
            p += b[i] * d[i];
        total -= p * p;
    }
    return total;
}

PRT_TARGET_CLONES
void nearest_of_block(const float* block, const ClusterModels& models,
                      std::span<const std::uint32_t> candidates, std::uint32_t* clusters, float* errors) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        errors[lane] = std::numeric_limits<float>::infinity();
    for (const std::size_t k : candidates) {
        const Lanes distance =
            squared_distance(block, models.dimension, models.means.data() + k * models.dimension,
                             models.directions.data() + k * models.max_components * models.dimension,
                             static_cast<std::size_t>(models.components[k])) +
            models.penalties[k];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const bool nearer = distance[lane] < errors[lane];
            errors[lane] = nearer ? distance[lane] : errors[lane];
            clusters[lane] = nearer ? static_cast<std::uint32_t>(k) : clusters[lane];
        }
    }
}

PRT_TARGET_CLONES
void distances_of_block(const float* block, std::size_t dimension, const float* center, float* distances) {
    const Lanes distance = squared_distance(block, dimension, center, nullptr, 0);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        distances[lane] = distance[lane];
}

} // namespace

PointBlocks::PointBlocks(const Transfer& transfer, const Frame& frame, int threads)
    : count(transfer.receivers()), dimension(frame.dimension) {
    if (dimension == 0) // all receivers alike
        return;
    values.resize(blocks() * dimension * kLanes);
    parallel_for(blocks(), 64, threads, [&](std::size_t begin, std::size_t end) {
        const auto full = static_cast<Eigen::Index>(frame.full()),
                   kept = static_cast<Eigen::Index>(dimension);
        const Eigen::Map<const Eigen::MatrixXd> analysis(frame.analysis.data(), full, kept);
        const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
        Eigen::MatrixXd vectors(full, static_cast<Eigen::Index>(kLanes));
        for (std::size_t b = begin; b < end; ++b) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const std::size_t p = b * kLanes + lane < count ? b * kLanes + lane : b * kLanes;
                const Eigen::Map<const Eigen::VectorXf> vector(transfer.vector(p).data(), full);
                vectors.col(static_cast<Eigen::Index>(lane)) = vector.cast<double>() - origin;
            }
            Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
                values.data() + b * dimension * kLanes, kept, static_cast<Eigen::Index>(kLanes)) =
                (analysis.transpose() * vectors).cast<float>();
        }
    });
}

namespace {

/// Assigns all points; `candidates_of(b, list)` says which clusters the points of a block may have.
template <class CandidatesOf>
Assignment assign_among(const PointBlocks& points, const ClusterModels& models, int threads,
                        CandidatesOf&& candidates_of) {
    Assignment result{std::vector<std::uint32_t>(points.count), std::vector<float>(points.count)};
    parallel_for(points.blocks(), 32, threads, [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<std::uint32_t, kLanes> clusters{};
        alignas(64) std::array<float, kLanes> errors{};
        std::vector<std::uint32_t> candidates;
        for (std::size_t b = begin; b < end; ++b) {
            candidates_of(b, candidates);
            nearest_of_block(points.block(b), models, candidates, clusters.data(), errors.data());
            const std::size_t first = b * kLanes, n = std::min(kLanes, points.count - first);
            std::copy_n(clusters.begin(), n, &result.clusters[first]);
            std::transform(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(n),
                           &result.errors[first], [](float e) { return std::max(e, 0.0f); });
        }
    });
    return result;
}

} // namespace

Assignment assign(const PointBlocks& points, const ClusterModels& models, int threads) {
    std::vector<std::uint32_t> all(models.clusters());
    std::iota(all.begin(), all.end(), 0u);
    return assign_among(points, models, threads, [&](std::size_t, std::vector<std::uint32_t>& to) {
        if (to.empty())
            to = all;
    });
}

Assignment assign(const PointBlocks& points, const ClusterModels& models,
                  std::span<const std::vector<std::uint32_t>> candidates, std::span<const std::uint32_t> now,
                  int threads) {
    return assign_among(points, models, threads, [&](std::size_t b, std::vector<std::uint32_t>& to) {
        candidates_of_block(candidates, now, b, to);
    });
}

void candidates_of_block(std::span<const std::vector<std::uint32_t>> candidates,
                         std::span<const std::uint32_t> now, std::size_t b, std::vector<std::uint32_t>& to) {
    to.clear();
    for (std::size_t p = b * kLanes; p < std::min((b + 1) * kLanes, now.size()); ++p) {
        if (p > b * kLanes && now[p] == now[p - 1])
            continue;
        const auto& near = candidates[now[p]];
        to.insert(to.end(), near.begin(), near.end());
    }
    std::sort(to.begin(), to.end());
    to.erase(std::unique(to.begin(), to.end()), to.end());
}

double total_error(std::span<const float> weights, std::span<const float> errors) {
    double total = 0;
    for (std::size_t p = 0; p < errors.size(); ++p)
        total += static_cast<double>(weights[p]) * static_cast<double>(errors[p]);
    return total;
}

void lower_to_distance(const PointBlocks& points, const float* center, std::span<float> errors, int threads) {
    parallel_for(points.blocks(), 256, threads, [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<float, kLanes> distances{};
        for (std::size_t b = begin; b < end; ++b) {
            distances_of_block(points.block(b), points.dimension, center, distances.data());
            for (std::size_t p = b * kLanes; p < std::min((b + 1) * kLanes, points.count); ++p)
                errors[p] = std::min(errors[p], distances[p % kLanes]);
        }
    });
}

} // namespace prt
