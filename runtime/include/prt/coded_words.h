#pragma once

// Packed clusters and weights of receivers in files: predicted from neighbours, then coded by rANS with
// static models (docs/format.md). Experimental.

#include "prt/clustered_bases.h"
#include "prt/coded_rows.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Bit fields in the words of a receiver.
struct WordLayout {
    std::vector<ClusterLayout> clusters;
    int cluster_bits = 0;
    int words = 0; ///< 32-bit words per receiver
};

/// Up to three receivers before receiver v that predict it; unused entries are v.
using EarlierNeighbors = std::array<std::uint32_t, 3>;

/// Returns for each of `receivers` vertices up to three earlier neighbours: the first distinct vertices with
/// a smaller index that share a triangle with it and are in the same block of receivers. They are in the
/// order of `triangles` [triangles][3]; within one triangle the smaller index is first. Throws `Error` if a
/// triangle has a vertex that does not exist.
std::vector<EarlierNeighbors> earlier_neighbors(std::span<const std::uint32_t> triangles,
                                                std::size_t receivers);

/// Coded words of all receivers: the symbol frequencies of each context, and the coded symbols.
struct WordCode {
    RowCode frequencies;
    std::vector<std::byte> bits;
};

/// Returns whether a code can represent the words exactly: all clusters exist, and all bits after the weights
/// are zero.
bool can_code_words(const WordLayout& layout, std::span<const std::uint32_t> words);

/// Codes `words` [receivers][layout.words], for which `can_code_words` must be true.
WordCode encode_words(const WordLayout& layout, std::span<const EarlierNeighbors> neighbors,
                      std::span<const std::uint32_t> words);

/// Decodes the words [receivers][layout.words] without loss. Throws `Error` if the code is damaged. Callers
/// must limit the number of receivers, because a few bytes can encode any number of equal ones. Blocks of
/// 16384 receivers are decoded on `threads` threads (0: all).
std::vector<std::uint32_t> decode_words(const WordCode& code, const WordLayout& layout,
                                        std::span<const EarlierNeighbors> neighbors, int threads = 0);

} // namespace prt
