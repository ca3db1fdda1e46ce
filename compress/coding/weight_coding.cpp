// Codes points: a cluster, and weights on its grids, rounded one after another for the residual of the
// previous ones. This is matching pursuit over the rows in order (Mallat and Zhang 1993).

#include "compress/coding/weight_coding.h"

#include "compress/clusters/cluster_neighbours.h"

namespace prt {
namespace {

/// Data of a cluster for the kernel.
struct KernelCluster {
    const float* mean;
    const float* center;
    const float* slopes;
    const float* rows;
    const WeightGrid* grids;
    const RowReach* reaches;
    std::size_t components, predictors;
};

/// Rounds to the nearest integer by adding and subtracting 1.5 · 2^23, for much smaller values.
template <class Value>
[[gnu::always_inline]] inline Value rounded(const Value& v) {
    constexpr float kMagic = 12582912.0f;
    return (v + kMagic) - kMagic;
}

/// Points for the kernel, [width][kLanes].
struct KernelPoints {
    const float* block;
    std::size_t dimension;
    const float* scales; ///< [groups][kLanes], or null: equal weights
    const std::uint8_t* group_of;

    KernelPoints from(int lane) const {
        return {points_from(block, lane), dimension, points_from(scales, lane), group_of};
    }
};

/// Returns the squared distance of `Width` points to their decoded values in this cluster; writes the weights
/// to `weights` [components][kLanes] unless it is null. `Scaled`: points have scales, so that the length of a
/// row varies per point.
template <int Width, bool Scaled, class Value = typename Floats<Width>::Value>
[[gnu::always_inline]] inline Value code_points(const KernelPoints& points, const KernelCluster& k,
                                                float* weights) {
    const std::size_t dimension = points.dimension;
    const auto scale = [&](std::size_t i) __attribute__((always_inline)) {
        return floats_at<Width>(points.scales + points.group_of[i] * kLanes);
    };
    Value d[kMaxDimensions];
    known_subtracted<Width>(points.block, dimension, k.mean, k.center, k.slopes, k.predictors, d);
    for (std::size_t i = 0; Scaled && i < dimension; ++i)
        d[i] *= scale(i);
    for (std::size_t j = 0; j < k.components; ++j) {
        const float* row = k.rows + j * dimension;
        Value dot = {}, w;
        if constexpr (Scaled) {
            Value norm = {};
            for (std::size_t i = 0; i < dimension; ++i) {
                const Value r = row[i] * scale(i);
                dot += r * d[i];
                norm += r * r;
            }
            w = dot / (norm > 1e-30f ? norm : Value{} + 1e30f);
        } else {
            for (std::size_t i = 0; i < dimension; ++i)
                dot += row[i] * d[i];
            w = dot * k.reaches[j].inverse_norm;
        }
        if (!k.grids[j].is_any()) {
            const float steps = k.grids[j].steps();
            w = w < -1.0f ? Value{} - 1.0f : w;
            w = w > 1.0f ? Value{} + 1.0f : w;
            w = rounded((w + 1.0f) * steps) / steps - 1.0f;
        }
        for (std::size_t i = 0; i < dimension; ++i)
            if constexpr (Scaled)
                d[i] -= w * (row[i] * scale(i));
            else
                d[i] -= w * row[i];
        if (weights)
            for (int lane = 0; lane < Width; ++lane)
                weights[j * kLanes + static_cast<std::size_t>(lane)] = w[lane];
    }
    Value total = {};
    for (std::size_t i = 0; i < dimension; ++i)
        total += d[i] * d[i];
    return total;
}

template <int Width, bool Scaled>
[[gnu::always_inline]] inline void
best_of(const KernelPoints& points, std::span<const KernelCluster> clusters,
        std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    const auto distance = [&](std::uint32_t k) __attribute__((always_inline)) {
        return code_points<Width, Scaled>(points, clusters[k], nullptr);
    };
    keep_nearest<Width>(candidates, best, errors, distance);
}

PRT_WIDE_TARGET
void best_at_once(const KernelPoints& points, std::span<const KernelCluster> clusters,
                  std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    if (points.scales)
        best_of<kLaneCount, true>(points, clusters, candidates, best, errors);
    else
        best_of<kLaneCount, false>(points, clusters, candidates, best, errors);
}

PRT_TWO_CLONES
void best_by_parts(const KernelPoints& points, std::span<const KernelCluster> clusters,
                   std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    for (int first = 0; first < kLaneCount; first += kNarrow)
        if (points.scales)
            best_of<kNarrow, true>(points.from(first), clusters, candidates, best + first, errors + first);
        else
            best_of<kNarrow, false>(points.from(first), clusters, candidates, best + first, errors + first);
}

void best_of_block(const KernelPoints& points, std::span<const KernelCluster> clusters,
                   std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    (has_wide_registers() ? best_at_once : best_by_parts)(points, clusters, candidates, best, errors);
}

PRT_TWO_CLONES
void weights_of_block(const KernelPoints& points, const KernelCluster& cluster, float* weights,
                      float* errors) {
    for (int first = 0; first < kLaneCount; first += kNarrow) {
        auto* const to = reinterpret_cast<Floats<kNarrow>::InMemory*>(errors + first);
        *to = points.scales ? code_points<kNarrow, true>(points.from(first), cluster, weights + first)
                            : code_points<kNarrow, false>(points.from(first), cluster, weights + first);
    }
}

/// Buffer for the scales of points that are processed together.
class GatheredScales {
public:
    explicit GatheredScales(const PointBlocks& points)
        : points_(points), scales_(points.scales.groups * kLanes) {}

    /// Returns the members of `block`.
    KernelPoints of(const MemberBlock& members, const float* block) {
        if (points_.scales.all_alike())
            return {block, points_.dimension, nullptr, nullptr};
        points_.scales.gather(members.points, scales_.data());
        return {block, points_.dimension, scales_.data(), points_.scales.group_of.data()};
    }

private:
    const PointBlocks& points_;
    std::vector<float> scales_;
};

/// Returns the extents of rows, [clusters][max_components].
std::vector<RowReach> reaches_of_codes(const AffineClusters& clusters) {
    std::vector<RowReach> result(clusters.clusters() * clusters.max_components);
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        for (std::size_t j = 0; j < clusters.components_of(k); ++j) {
            double squared = 0;
            for (std::size_t i = 0; i < clusters.dimension; ++i)
                squared +=
                    static_cast<double>(clusters.row(k, j)[i]) * static_cast<double>(clusters.row(k, j)[i]);
            // A row that rounding has made zero codes nothing.
            result[k * clusters.max_components + j].inverse_norm =
                squared > 1e-30 ? static_cast<float>(1 / squared) : 0.0f;
        }
    return result;
}

/// All clusters for the kernel, and the data that they reference.
struct Kernel {
    std::vector<RowReach> reaches;
    std::vector<KernelCluster> clusters;

    explicit Kernel(const QuantisedClusters& of) : reaches(reaches_of_codes(of)) {
        for (std::size_t k = 0; k < of.clusters(); ++k) {
            const std::size_t first = k * of.max_components;
            clusters.push_back({of.mean(k), of.center(k), of.slope(k, 0), of.row(k, 0),
                                of.grids.data() + first, reaches.data() + first, of.components_of(k),
                                of.predictors});
        }
    }
};

/// Computes weights and errors of all points in their clusters.
void code_in_clusters(const PointBlocks& points, const QuantisedClusters& clusters, const Kernel& kernel,
                      Codes& codes, int threads) {
    codes.errors.resize(points.count);
    codes.weights = CodeWeights(points.count, clusters);
    for_member_blocks(points, codes.clusters, threads, [&](const MemberBlock& members, const float* block) {
        const KernelCluster& cluster = kernel.clusters[members.cluster];
        alignas(64) std::array<float, kMaxDimensions * kLanes> weights;
        alignas(64) std::array<float, kLanes> errors{};
        std::array<float, kMaxDimensions> own;
        GatheredScales scales(points);
        weights_of_block(scales.of(members, block), cluster, weights.data(), errors.data());
        for (std::size_t lane = 0; lane < members.points.size(); ++lane) {
            const std::size_t p = members.points[lane];
            codes.errors[p] = errors[lane];
            for (std::size_t j = 0; j < cluster.components; ++j)
                own[j] = weights[j * kLanes + lane];
            codes.weights.write(clusters, members.cluster, p, own.data());
        }
    });
}

} // namespace

void encode_in_place(const PointBlocks& points, const QuantisedClusters& clusters, Codes& codes,
                     int threads) {
    code_in_clusters(points, clusters, Kernel(clusters), codes, threads);
}

void encode_points(const PointBlocks& points, const QuantisedClusters& clusters,
                   const ClusterLists& candidates, Codes& codes, int threads) {
    const Kernel kernel(clusters);
    codes.clusters =
        reassign_members(points, candidates, codes.clusters, threads,
                         [&](const MemberBlock& members, const float* block,
                             std::span<const std::uint32_t> near, std::uint32_t* best, float* errors) {
                             GatheredScales scales(points);
                             best_of_block(scales.of(members, block), kernel.clusters, near, best, errors);
                         });
    code_in_clusters(points, clusters, kernel, codes, threads);
}

ClusterLists neighbours_of_codes(const QuantisedClusters& clusters, std::size_t most, int threads) {
    return neighbour_clusters(clusters, reaches_of_codes(clusters), most, threads);
}

void keep_better(const PointBlocks& points, const QuantisedClusters& clusters, const Codes& before,
                 Codes& codes, int threads) {
    parallel_for(points.count, 1024, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> rest(points.width()), w(clusters.max_components);
        for (std::size_t p = begin; p < end; ++p) {
            const std::size_t k = before.clusters[p];
            before.read(clusters, p, w.data());
            points.copy_point(p, rest.data());
            subtract_known(clusters, k, rest.data());
            for (std::size_t j = 0; j < clusters.components_of(k); ++j)
                for (std::size_t i = 0; i < clusters.dimension; ++i)
                    rest[i] -= w[j] * clusters.row(k, j)[i];
            points.scales.multiply(p, rest.data());
            float error = 0;
            for (std::size_t i = 0; i < clusters.dimension; ++i)
                error += rest[i] * rest[i];
            if (!(error < codes.errors[p]))
                continue;
            codes.clusters[p] = before.clusters[p];
            codes.errors[p] = error;
            codes.weights.copy(before.weights, p);
        }
    });
}

} // namespace prt
