#pragma once

#include <cstddef>
#include <vector>

namespace prt {

/// An affine subspace per cluster: its points are near mean + sum_j w_j row_j (docs/math.md, eq. 20). Without
/// rows this is plain vector quantisation.
struct AffineClusters {
    std::size_t dimension = 0, max_components = 0;
    std::vector<float> means;    ///< [clusters][dimension]
    std::vector<float> rows;     ///< [clusters][max_components][dimension]
    std::vector<int> components; ///< [clusters] rows in use

    AffineClusters() = default;
    AffineClusters(std::size_t clusters, std::size_t dimensions, std::size_t most_components)
        : dimension(dimensions), max_components(most_components), means(clusters * dimensions),
          rows(clusters * most_components * dimensions), components(clusters, 0) {}

    std::size_t clusters() const { return components.size(); }
    std::size_t components_of(std::size_t k) const { return static_cast<std::size_t>(components[k]); }
    float* mean(std::size_t k) { return means.data() + k * dimension; }
    const float* mean(std::size_t k) const { return means.data() + k * dimension; }
    float* row(std::size_t k, std::size_t j) { return rows.data() + (k * max_components + j) * dimension; }
    const float* row(std::size_t k, std::size_t j) const {
        return rows.data() + (k * max_components + j) * dimension;
    }
};

} // namespace prt
