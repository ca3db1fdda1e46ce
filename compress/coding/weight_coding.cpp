// Codes points: a cluster, and weights on its grids, rounded one after the other to what the former left
// over. That is matching pursuit over the rows in their order (Mallat and Zhang 1993).

#include "coding/weight_coding.h"

#include "clusters/cluster_neighbours.h"

namespace prt {
namespace {

/// A cluster as the kernel reads it.
struct KernelCluster {
    const float* mean;
    const float* center;
    const float* slopes;
    const float* rows;
    const WeightGrid* grids;
    const RowReach* reaches;
    std::size_t components, guides;
};

/// Adding and taking away 1.5 · 2^23 rounds to the nearest integer what is far smaller.
template <class Value>
[[gnu::always_inline]] inline Value rounded(const Value& v) {
    constexpr float kMagic = 12582912.0f;
    return (v + kMagic) - kMagic;
}

/// Squared distance of `Width` points from the first of `block` on to what their codes in this cluster stand
/// for; the weights go to `weights` [components][kLanes] unless it is null.
template <int Width, class Value = typename Floats<Width>::Value>
[[gnu::always_inline]] inline Value code_points(const float* block, std::size_t dimension,
                                                const KernelCluster& k, float* weights) {
    Value d[kMostDimensions];
    known_subtracted<Width>(block, dimension, k.mean, k.center, k.slopes, k.guides, d);
    for (std::size_t j = 0; j < k.components; ++j) {
        const float* row = k.rows + j * dimension;
        Value dot = {};
        for (std::size_t i = 0; i < dimension; ++i)
            dot += row[i] * d[i];
        Value w = dot * k.reaches[j].inverse_norm;
        if (!k.grids[j].is_any()) {
            const float steps = k.grids[j].steps();
            w = w < -1.0f ? Value{} - 1.0f : w;
            w = w > 1.0f ? Value{} + 1.0f : w;
            w = rounded((w + 1.0f) * steps) / steps - 1.0f;
        }
        for (std::size_t i = 0; i < dimension; ++i)
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

template <int Width>
[[gnu::always_inline]] inline void
best_of(const float* block, std::size_t dimension, std::span<const KernelCluster> clusters,
        std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    const auto distance = [&](std::uint32_t k) __attribute__((always_inline)) {
        return code_points<Width>(block, dimension, clusters[k], nullptr);
    };
    keep_nearest<Width>(candidates, best, errors, distance);
}

PRT_WIDE_TARGET
void best_at_once(const float* block, std::size_t dimension, std::span<const KernelCluster> clusters,
                  std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    best_of<kLaneCount>(block, dimension, clusters, candidates, best, errors);
}

PRT_TWO_CLONES
void best_by_parts(const float* block, std::size_t dimension, std::span<const KernelCluster> clusters,
                   std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    for (int first = 0; first < kLaneCount; first += kNarrow)
        best_of<kNarrow>(points_from(block, first), dimension, clusters, candidates, best + first,
                         errors + first);
}

void best_of_block(const float* block, std::size_t dimension, std::span<const KernelCluster> clusters,
                   std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    (has_wide_registers() ? best_at_once : best_by_parts)(block, dimension, clusters, candidates, best,
                                                          errors);
}

PRT_TWO_CLONES
void weights_of_block(const float* block, std::size_t dimension, const KernelCluster& cluster, float* weights,
                      float* errors) {
    for (int first = 0; first < kLaneCount; first += kNarrow)
        *reinterpret_cast<Floats<kNarrow>::InMemory*>(errors + first) =
            code_points<kNarrow>(points_from(block, first), dimension, cluster, weights + first);
}

/// [clusters][max_components]
std::vector<RowReach> reaches_of_codes(const AffineClusters& clusters) {
    std::vector<RowReach> result(clusters.clusters() * clusters.max_components);
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        for (std::size_t j = 0; j < clusters.components_of(k); ++j) {
            double squared = 0;
            for (std::size_t i = 0; i < clusters.dimension; ++i)
                squared +=
                    static_cast<double>(clusters.row(k, j)[i]) * static_cast<double>(clusters.row(k, j)[i]);
            // A row that rounding has emptied codes nothing.
            result[k * clusters.max_components + j].inverse_norm =
                squared > 1e-30 ? static_cast<float>(1 / squared) : 0.0f;
        }
    return result;
}

/// All clusters as the kernel reads them, and what they point to.
struct Kernel {
    std::vector<RowReach> reaches;
    std::vector<KernelCluster> clusters;

    explicit Kernel(const QuantisedClusters& of) : reaches(reaches_of_codes(of)) {
        for (std::size_t k = 0; k < of.clusters(); ++k) {
            const std::size_t first = k * of.max_components;
            clusters.push_back({of.mean(k), of.center(k), of.slope(k, 0), of.row(k, 0),
                                of.grids.data() + first, reaches.data() + first, of.components_of(k),
                                of.guides});
        }
    }
};

/// Weights and errors of all points in the clusters that they have.
void code_in_clusters(const PointBlocks& points, const QuantisedClusters& clusters, const Kernel& kernel,
                      Codes& codes, int threads) {
    codes.errors.resize(points.count);
    codes.weights = CodeWeights(points.count, clusters);
    for_member_blocks(points, codes.clusters, threads, [&](const MemberBlock& members, const float* block) {
        const KernelCluster& cluster = kernel.clusters[members.cluster];
        alignas(64) std::array<float, kMostDimensions * kLanes> weights;
        alignas(64) std::array<float, kLanes> errors{};
        std::array<float, kMostDimensions> own;
        weights_of_block(block, points.dimension, cluster, weights.data(), errors.data());
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
    codes.clusters = reassign_members(
        points, candidates, codes.clusters, threads,
        [&](const float* block, std::span<const std::uint32_t> near, std::uint32_t* best, float* errors) {
            best_of_block(block, points.dimension, kernel.clusters, near, best, errors);
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
