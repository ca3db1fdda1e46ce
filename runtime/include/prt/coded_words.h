#pragma once

// Packed clusters and weights of receivers as a file keeps them: predicted from neighbours, then coded by
// rANS with static models (docs/format.md). Experimental.

#include "prt/clustered_bases.h"
#include "prt/coded_rows.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Fields of the words of a receiver.
struct WordLayout {
    std::vector<ClusterLayout> clusters;
    int cluster_bits = 0;
    int words = 0; ///< of a receiver
};

/// Up to three receivers that precede receiver v and that predict it; entries not used are v.
using EarlierNeighbors = std::array<std::uint32_t, 3>;

/// Neighbours of each of `receivers` vertices along the edges of `triangles` [triangles][3]: the first three
/// distinct ones of its block with a smaller index, in the order of the triangles, within one the smaller
/// first. Throws `Error` where a triangle has a vertex that does not exist.
std::vector<EarlierNeighbors> earlier_neighbors(std::span<const std::uint32_t> triangles,
                                                std::size_t receivers);

/// Words of all receivers: the frequencies of the symbols in each context, and the coded symbols.
struct WordCode {
    RowCode frequencies;
    std::vector<std::byte> bits;
};

/// Whether the words hold nothing but what a code keeps: existing clusters, and zeros behind the weights.
bool can_code_words(const WordLayout& layout, std::span<const std::uint32_t> words);

/// Codes `words` [receivers][layout.words], which can_code_words.
WordCode encode_words(const WordLayout& layout, std::span<const EarlierNeighbors> neighbors,
                      std::span<const std::uint32_t> words);

/// The words [receivers][layout.words], bit for bit. Throws `Error` where the code is damaged. A few bytes
/// may stand for any number of equal receivers: callers limit it. Blocks of 16384 receivers are shared out
/// among `threads` threads (0: all).
std::vector<std::uint32_t> decode_words(const WordCode& code, const WordLayout& layout,
                                        std::span<const EarlierNeighbors> neighbors, int threads = 0);

} // namespace prt
