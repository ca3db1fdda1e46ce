// Decodes transfer vectors from means, predictors and weighted basis directions: docs/math.md, eq. 20.

#include "runtime/core/transfer/clustered_vectors.h"

#include "runtime/core/support/parallel.h"

#include <algorithm>

namespace prt {

void ClusteredVectors::read(std::size_t first, std::span<float> to) const {
    const ClusteredBases& bases = transfer_.bases;
    const std::size_t dimension = dimension_, predictors = bases.predictor_rows();
    std::vector<float> weights(max_components_);
    for (std::size_t p = first; !to.empty(); ++p, to = to.subspan(dimension)) {
        const std::size_t k = transfer_.receivers.cluster(p);
        const ClusterLayout& layout = layouts_[k];
        decode_weights(transfer_, layouts_, p, weights);
        const float* row = &bases.rows[layout.first_row * dimension];
        const std::span<float> out = to.first(dimension);
        std::copy_n(row, dimension, out.begin());
        const auto add_row = [&](float weight) {
            row += dimension;
            for (std::size_t i = 0; i < dimension; ++i)
                out[i] += weight * row[i];
        };
        for (std::size_t g = 0; g < predictors; ++g)
            add_row(bases.predictor_scale(g) * transfer_.receivers.predictors[p * predictors + g] -
                    static_cast<float>(bases.centers[k * predictors + g]));
        for (std::size_t j = 0; j < layout.components; ++j)
            add_row(weights[j]);
    }
}

Transfer decode(const ClusteredTransfer& transfer, int threads) {
    const ClusteredVectors vectors(transfer);
    Transfer result = zero_transfer(transfer.bases.layout, transfer.receivers.size());
    const std::size_t dimension = result.dimension();
    parallel_for(transfer.receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        vectors.read(begin, std::span(result.vectors).subspan(begin * dimension, (end - begin) * dimension));
    });
    return result;
}

} // namespace prt
