// Reads, packs and unpacks the weights of receivers.
#include "runtime/core/transfer/packed_weights.h"

#include "prt/core/clustered_transfer.h"
#include "prt/core/error.h"

#include <algorithm>
#include <string>

namespace prt {

void decode_weights(const ClusteredTransfer& transfer, std::span<const ClusterLayout> layouts,
                    std::size_t receiver, std::span<float> weights) {
    const ClusteredReceivers& receivers = transfer.receivers;
    const ClusterLayout& layout = layouts[receivers.cluster(receiver)];
    const std::byte* from = receivers.weights.data() + receiver * receivers.stride();
    auto position = static_cast<std::size_t>(receivers.cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j) {
        if (receivers.format == WeightFormat::float32) {
            weights[j] = load<float>(from + 4 * j);
            continue;
        }
        const int width = width_of(layout, j);
        const auto largest = static_cast<float>((1u << width) - 1);
        weights[j] = (2 * static_cast<float>(bits_at(from, position, width)) - largest) / largest;
        position += static_cast<std::size_t>(width);
    }
}

void pack_words(std::uint32_t cluster, int cluster_bits, const ClusterLayout& layout,
                std::span<const std::uint32_t> values, std::span<std::uint32_t> words) {
    std::fill(words.begin(), words.end(), 0u);
    std::size_t position = 0;
    const auto put = [&](std::uint32_t value, int width) {
        const std::size_t word = position / 32, shift = position % 32;
        words[word] |= value << shift;
        if (shift + static_cast<std::size_t>(width) > 32)
            words[word + 1] |= value >> (32 - shift);
        position += static_cast<std::size_t>(width);
    };
    put(cluster, cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j)
        put(values[j], width_of(layout, j));
}

void check_clusters(std::size_t clusters, std::size_t first, std::size_t count, const char* what,
                    const ClusteredReceivers& receivers) {
    for (std::size_t p = first; p < first + count; ++p)
        if (const std::size_t k = receivers.cluster(p); k >= clusters)
            throw Error(std::string(what) + " " + std::to_string(p - first) + " has cluster " +
                        std::to_string(k) + ", but there are only " + std::to_string(clusters));
}

} // namespace prt
