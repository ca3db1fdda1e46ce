#pragma once

#include "metric/frame.h"
#include "prt/support/vector_lanes.h"
#include "prt/transfer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Points that are worked on together: one per vector lane.
inline constexpr std::size_t kLanes = kLaneCount;
inline constexpr std::size_t kMostDimensions = 3 * kMaxOrder * kMaxOrder;

/// Transfer vectors as points of the space of a frame, laid out for vector units: blocks of kLanes points, in
/// each block coordinate by coordinate. The last block is filled up with copies of its first point.
struct PointBlocks {
    std::size_t count = 0, dimension = 0;
    std::vector<float> values; ///< [blocks][dimension][kLanes]

    PointBlocks(const Transfer& transfer, const Frame& frame, int threads);

    std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
    const float* block(std::size_t b) const { return values.data() + b * dimension * kLanes; }
    float coordinate(std::size_t point, std::size_t i) const {
        return values[(point / kLanes * dimension + i) * kLanes + point % kLanes];
    }
    void copy_point(std::size_t point, float* to) const {
        for (std::size_t i = 0; i < dimension; ++i)
            to[i] = coordinate(point, i);
    }
};

/// An affine subspace per cluster: a mean and orthonormal directions. No directions: plain vector
/// quantisation.
struct ClusterModels {
    std::size_t dimension = 0, max_components = 0;
    std::vector<float> means;      ///< [clusters][dimension]
    std::vector<float> directions; ///< [clusters][max_components][dimension]
    std::vector<int> components;   ///< [clusters] directions in use
    std::vector<float> penalties;  ///< [clusters] added to the squared distance of a point

    ClusterModels(std::size_t clusters, std::size_t dimensions, std::size_t components_at_most)
        : dimension(dimensions), max_components(components_at_most), means(clusters * dimensions),
          directions(clusters * components_at_most * dimensions), components(clusters, 0),
          penalties(clusters, 0.0f) {}

    std::size_t clusters() const { return components.size(); }
    float* mean(std::size_t k) { return means.data() + k * dimension; }
    const float* mean(std::size_t k) const { return means.data() + k * dimension; }
    float* direction(std::size_t k, std::size_t j) {
        return directions.data() + (k * max_components + j) * dimension;
    }
    const float* direction(std::size_t k, std::size_t j) const {
        return directions.data() + (k * max_components + j) * dimension;
    }
};

struct Assignment {
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<float> errors; ///< [points] squared distance to the cluster's subspace, and its penalty
};

/// Gives each point the cluster whose subspace is nearest, penalties added; of equals the first.
Assignment assign(const PointBlocks& points, const ClusterModels& models, int threads);

/// The same among the `candidates` [clusters][..] of the cluster that a point has now, and of those of the
/// points beside it in memory.
Assignment assign(const PointBlocks& points, const ClusterModels& models,
                  std::span<const std::vector<std::uint32_t>> candidates, std::span<const std::uint32_t> now,
                  int threads);

/// All candidates of the points of block `b`, each once, ascending.
void candidates_of_block(std::span<const std::vector<std::uint32_t>> candidates,
                         std::span<const std::uint32_t> now, std::size_t b, std::vector<std::uint32_t>& to);

/// sum_p weights[p] errors[p], in a fixed order.
double total_error(std::span<const float> weights, std::span<const float> errors);

/// Lowers `errors` [points] to the squared distance to `center` [dimension] where that is less.
void lower_to_distance(const PointBlocks& points, const float* center, std::span<float> errors, int threads);

} // namespace prt
