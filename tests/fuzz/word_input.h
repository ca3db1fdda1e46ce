#pragma once

// Layout of the words in the first bytes of an input of `words`.

#include "runtime/core/transfer/coded_words.h"

namespace prt::fuzz {

inline constexpr std::size_t kWordHead = 6;

struct WordInput {
    WordLayout layout;
    std::vector<EarlierNeighbors> neighbors;
};

/// Decodes `head` [kWordHead]: clusters, components, bits, vertices, and distances between the corners of
/// triangles; the last byte is the end of the frequencies.
inline WordInput word_input(std::span<const std::uint8_t> head) {
    ClusteredBases bases;
    const int clusters = 1 + head[0] % 20;
    WordInput input;
    input.layout.cluster_bits = clusters == 1 ? 0 : clusters <= 8 ? 3 : 5;
    int most = 0;
    for (int k = 0; k < clusters; ++k) {
        bases.components.push_back((head[1] + k) % 17);
        int bits = input.layout.cluster_bits;
        for (int j = 0; j < bases.components.back(); ++j) {
            bases.bits.push_back(static_cast<std::uint8_t>(1 + (head[2] + 3 * j + k) % 16));
            bits += bases.bits.back();
        }
        most = std::max(most, bits);
    }
    input.layout.clusters = cluster_layouts(bases);
    input.layout.words = std::max(1, (most + 31) / 32);
    const std::uint32_t vertices = head[3] + 1u, step = head[4];
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t v = 0; v < vertices; ++v)
        triangles.insert(triangles.end(), {v, (v + 1) % vertices, (v + step) % vertices});
    input.neighbors = earlier_neighbors(triangles, vertices);
    return input;
}

} // namespace prt::fuzz
