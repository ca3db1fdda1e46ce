#pragma once

// Clusters as affine subspaces.

#include <cstddef>
#include <vector>

namespace prt {

/// An affine subspace per cluster: its points are close to mean + sum_i (x_i - center_i) predictor_i + sum_j
/// w_j row_j with x the predictor coordinates of the point (docs/math.md, eq. 20). Without rows this is plain
/// vector quantisation.
struct AffineClusters {
    std::size_t dimension = 0, max_components = 0;
    std::size_t predictors = 0;
    std::vector<float> means;    ///< [clusters][dimension]
    std::vector<float> slopes;   ///< [clusters][predictors][dimension]
    std::vector<float> centers;  ///< [clusters][predictors]
    std::vector<float> rows;     ///< [clusters][max_components][dimension]
    std::vector<int> components; ///< [clusters] number of used rows

    AffineClusters() = default;
    AffineClusters(std::size_t clusters, std::size_t dimensions, std::size_t component_limit,
                   std::size_t predictor_count = 0)
        : dimension(dimensions), max_components(component_limit), predictors(predictor_count),
          means(clusters * dimensions), slopes(clusters * predictor_count * dimensions),
          centers(clusters * predictor_count), rows(clusters * component_limit * dimensions),
          components(clusters, 0) {}

    std::size_t clusters() const { return components.size(); }
    std::size_t components_of(std::size_t k) const { return static_cast<std::size_t>(components[k]); }
    float* mean(std::size_t k) { return means.data() + k * dimension; }
    const float* mean(std::size_t k) const { return means.data() + k * dimension; }
    float* slope(std::size_t k, std::size_t g) { return slopes.data() + (k * predictors + g) * dimension; }
    const float* slope(std::size_t k, std::size_t g) const {
        return slopes.data() + (k * predictors + g) * dimension;
    }
    float* center(std::size_t k) { return centers.data() + k * predictors; }
    const float* center(std::size_t k) const { return centers.data() + k * predictors; }
    float* row(std::size_t k, std::size_t j) { return rows.data() + (k * max_components + j) * dimension; }
    const float* row(std::size_t k, std::size_t j) const {
        return rows.data() + (k * max_components + j) * dimension;
    }
};

/// Calls `visit(row, factor)` for the rows of cluster `k` in file order: its mean and predictor rows with
/// factor 1, its directions with 2. The factor is the multiple of the step that they are rounded to.
template <class Clusters, class Visit>
void for_rows(Clusters& clusters, std::size_t k, Visit&& visit) {
    visit(clusters.mean(k), 1);
    for (std::size_t g = 0; g < clusters.predictors; ++g)
        visit(clusters.slope(k, g), 1);
    for (std::size_t j = 0; j < clusters.components_of(k); ++j)
        visit(clusters.row(k, j), 2);
}

/// Subtracts the mean and predictor term of cluster `k` from `point` [dimension + predictors], in place, from
/// the first `dimension` numbers.
inline void subtract_known(const AffineClusters& clusters, std::size_t k, float* point) {
    const float* predictors = point + clusters.dimension;
    for (std::size_t i = 0; i < clusters.dimension; ++i)
        point[i] -= clusters.mean(k)[i];
    for (std::size_t g = 0; g < clusters.predictors; ++g) {
        const float x = predictors[g] - clusters.center(k)[g];
        for (std::size_t i = 0; i < clusters.dimension; ++i)
            point[i] -= x * clusters.slope(k, g)[i];
    }
}

} // namespace prt
