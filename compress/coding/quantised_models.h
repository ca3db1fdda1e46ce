#pragma once

#include "clusters/clustering.h"
#include "clusters/points.h"

namespace prt {

/// Clusters as a file holds them: a point is mean + sum_j w_j row_j. Weights lie in [-1, 1] on a grid of
/// 2 half + 1 values, or are free where half is 0. Rows need not be orthogonal.
struct QuantisedModels {
    std::size_t dimension = 0, max_components = 0;
    std::vector<float> means;    ///< [clusters][dimension]
    std::vector<float> rows;     ///< [clusters][max_components][dimension]
    std::vector<float> halves;   ///< [clusters][max_components]
    std::vector<int> components; ///< [clusters]

    std::size_t clusters() const { return components.size(); }
    float* mean(std::size_t k) { return means.data() + k * dimension; }
    const float* mean(std::size_t k) const { return means.data() + k * dimension; }
    float* row(std::size_t k, std::size_t j) { return rows.data() + (k * max_components + j) * dimension; }
    const float* row(std::size_t k, std::size_t j) const {
        return rows.data() + (k * max_components + j) * dimension;
    }
};

/// What every point is coded as.
struct Codes {
    std::size_t max_components = 0;
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<float> weights;          ///< [points][max_components], on the grid
    std::vector<float> errors; ///< [points] squared distance of the point to what its code stands for

    std::span<const float> of(std::size_t point) const {
        return std::span(weights).subspan(point * max_components, max_components);
    }
};

/// `half` of a weight of `bits` bits: 2^bits values, symmetric about zero, without zero.
inline float half_of_bits(int bits) {
    return 0.5f * (static_cast<float>(1u << bits) - 1.0f);
}

/// The nearest weight on the grid of `half`.
float round_weight(float weight, float half);

/// Rows from the principal axes of `clustering`, each as long as loses least when the weights of its points
/// are rounded. `half` of all weights, or 0: by the bits of each cluster's plan.
QuantisedModels quantised_models(const PointBlocks& points, std::span<const float> weights,
                                 const Clustering& clustering, bool free_weights, float half, int threads);

/// Codes every point in its cluster. Weights are rounded one after the other, each to what the former left
/// over.
void encode_in_place(const PointBlocks& points, const QuantisedModels& models, Codes& codes, int threads);

/// Codes every point in the cluster where it loses least, of the `candidates` [clusters][..] of its present
/// one and of those of the points beside it in memory.
void encode_points(const PointBlocks& points, const QuantisedModels& models,
                   std::span<const std::vector<std::uint32_t>> candidates, Codes& codes, int threads);

/// Gives points their code of `before` back where it loses less: weights are rounded one after the other,
/// which is not always the best where rows are not orthogonal, and what refit has found for a code must not
/// be lost.
void keep_better(const PointBlocks& points, const QuantisedModels& models, const Codes& before, Codes& codes,
                 int threads);

/// Clusters that are near each other: for each the `most` whose subspaces are nearest to its mean, itself
/// first.
std::vector<std::vector<std::uint32_t>> neighbour_clusters(const QuantisedModels& models, std::size_t most,
                                                           int threads);

/// Means and rows that fit the codes best, by weighted least squares.
void refit(const PointBlocks& points, std::span<const float> weights, const Codes& codes,
           QuantisedModels& models, int threads);

/// Rounds means to multiples of `step` and rows to multiples of 2 `step`.
void round_rows(QuantisedModels& models, double step);

} // namespace prt
