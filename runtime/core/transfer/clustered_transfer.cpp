// Sizes of compressed transfer, and its exit radiance under a light.
#include "prt/core/clustered_transfer.h"

#include "prt/core/cluster_lighting.h"
#include "runtime/core/transfer/packed_weights.h"

#include <algorithm>

namespace prt {

std::size_t ClusteredReceivers::stride() const {
    return 4 * static_cast<std::size_t>(format == WeightFormat::packed ? words : components);
}

std::size_t ClusteredReceivers::size() const {
    return format == WeightFormat::packed && words > 0 ? weights.size() / stride() : clusters.size();
}

std::size_t ClusteredReceivers::cluster(std::size_t receiver) const {
    return format == WeightFormat::packed ? cluster_in(weights.data() + receiver * stride(), cluster_bits)
                                          : clusters[receiver];
}

std::vector<std::uint16_t> ClusteredReceivers::cluster_indices() const {
    if (format != WeightFormat::packed)
        return clusters;
    std::vector<std::uint16_t> indices(size());
    for (std::size_t p = 0; p < indices.size(); ++p)
        indices[p] = static_cast<std::uint16_t>(cluster(p));
    return indices;
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
                    static_cast<std::size_t>(bases.max_components()) * sizeof(float));
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
    const ClusterLighting relighter(transfer);
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(lighting, constants);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    evaluate(transfer, constants, radiance, threads);
    return radiance;
}

std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads) {
    return exit_radiance(transfer, Lighting{light}, threads);
}

} // namespace prt
