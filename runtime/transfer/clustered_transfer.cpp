// Sizes of compressed transfer, and what it stands for.
#include "prt/clustered_transfer.h"

#include "prt/constant_former.h"
#include "prt/support/parallel.h"
#include "transfer/packed_weights.h"

#include <algorithm>
#include <cassert>

namespace prt {

std::size_t bytes_per_weight(WeightFormat format) {
    switch (format) {
    case WeightFormat::snorm16:
        return 2;
    case WeightFormat::snorm8:
        return 1;
    case WeightFormat::float32:
    case WeightFormat::packed:
        break;
    }
    assert(format == WeightFormat::float32);
    return 4;
}

std::size_t ClusteredReceivers::stride() const {
    return format == WeightFormat::packed ? static_cast<std::size_t>(words) * 4
                                          : static_cast<std::size_t>(components) * bytes_per_weight(format);
}

std::size_t bytes_per_receiver(const ClusteredTransfer& transfer) {
    const ClusteredReceivers& receivers = transfer.receivers;
    if (receivers.format == WeightFormat::packed)
        return receivers.stride();
    return 4 + receivers.stride();
}

std::size_t bits_per_receiver(const ClusteredTransfer& transfer) {
    const ClusteredReceivers& receivers = transfer.receivers;
    const ClusteredBases& bases = transfer.bases;
    if (receivers.format != WeightFormat::packed)
        return 8 * ((bases.clusters() > 256 ? 2 : 1) +
                    static_cast<std::size_t>(bases.max_components()) * bytes_per_weight(receivers.format));
    std::size_t most = 0;
    for (const ClusterLayout& layout : cluster_layouts(bases)) {
        auto bits = static_cast<std::size_t>(receivers.cluster_bits);
        for (std::size_t j = 0; j < layout.components; ++j)
            bits += static_cast<std::size_t>(width_of(layout, j));
        most = std::max(most, bits);
    }
    return most;
}

std::size_t constant_rows(const ClusteredBases& bases) {
    return bases.first_rows().back();
}

std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Lighting& lighting,
                                     int threads) {
    const ConstantFormer former(transfer);
    std::vector<glm::vec4> constants(former.rows());
    former.form(lighting, constants);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    evaluate(transfer, constants, radiance, threads);
    return radiance;
}

std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads) {
    return exit_radiance(transfer, Lighting{light}, threads);
}

Transfer decode(const ClusteredTransfer& transfer, int threads) {
    const ClusteredBases& bases = transfer.bases;
    const std::size_t dimension = bases.dimension();
    const std::vector<ClusterLayout> layouts = cluster_layouts(bases);
    const std::size_t guides = bases.guide_rows();
    Transfer result = zero_transfer(bases.layout, transfer.receivers.size());
    parallel_for(transfer.receivers.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> weights(static_cast<std::size_t>(bases.max_components()));
        for (std::size_t p = begin; p < end; ++p) {
            const std::size_t k = transfer.receivers.clusters[p];
            const ClusterLayout& layout = layouts[k];
            decode_weights(transfer, layouts, p, weights);
            const float* row = &bases.rows[layout.first_row * dimension];
            const std::span<float> out = result.vector(p);
            std::copy_n(row, dimension, out.begin());
            const auto add_row = [&](float weight) {
                row += dimension;
                for (std::size_t i = 0; i < dimension; ++i)
                    out[i] += weight * row[i];
            };
            for (std::size_t g = 0; g < guides; ++g)
                add_row(bases.guide_scale(g) * transfer.receivers.guides[p * guides + g] -
                        static_cast<float>(bases.centers[k * guides + g]));
            for (std::size_t j = 0; j < layout.components; ++j)
                add_row(weights[j]);
        }
    });
    return result;
}

} // namespace prt
