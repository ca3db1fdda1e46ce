#pragma once

// Entropy code for the packed clusters and weights of receivers in files. Each receiver is predicted from its
// neighbours in the mesh. An rANS code (asymmetric numeral systems) with static symbol frequencies codes the
// differences (docs/format.md). Experimental.

#include "prt/core/clustered_bases.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Bit fields in the packed words of a receiver (`WeightFormat::packed`), from the lowest bit upwards: the
/// cluster index, then the weights of that cluster.
struct WordLayout {
    std::vector<ClusterLayout> clusters; ///< [clusters] number and bit widths of the weights of each cluster
    int cluster_bits = 0;                ///< number of bits of the cluster index
    int words = 0;                       ///< number of 32-bit words per receiver, at least 1
};

/// Indices of up to three receivers that predict receiver v; each index is below v. Unused entries are at the
/// end and contain v itself.
using EarlierNeighbors = std::array<std::uint32_t, 3>;

/// Returns the predicting receivers of each vertex, [receivers]. The entry of vertex v contains the first
/// three distinct vertices that share a triangle with v, have a smaller index than v, and are in the same
/// block of 16384 consecutive receivers as v. "First" is the order of `triangles` [triangles][3]; within a
/// triangle the smallest index is first, in any rotation of its indices. Throws `Error` if a triangle has an
/// index that is not below `receivers`.
std::vector<EarlierNeighbors> earlier_neighbors(std::span<const std::uint32_t> triangles,
                                                std::size_t receivers);

/// Entropy code of the words of all receivers.
struct WordCode {
    /// Symbol frequencies of each context of the rANS code: a fixed number of rows of 16 columns
    /// (docs/format.md). A context is a class of symbols with equal predictability, such as weights with one
    /// known neighbour.
    RowCode frequencies;
    /// Coded blocks of 16384 receivers; the last block can have fewer. The array starts with the lengths of
    /// all blocks in bytes, as little-endian 32-bit integers; all blocks follow.
    std::vector<std::byte> bits;
};

/// Returns whether `encode_words` can represent `words` [receivers][layout.words] exactly: every cluster
/// index is below layout.clusters.size(), and all bits after the weights of a receiver are 0.
bool can_code_words(const WordLayout& layout, std::span<const std::uint32_t> words);

/// Returns the code of `words` [receivers][layout.words], for which `can_code_words` must be true.
/// `neighbors` [receivers] is the result of `earlier_neighbors`.
WordCode encode_words(const WordLayout& layout, std::span<const EarlierNeighbors> neighbors,
                      std::span<const std::uint32_t> words);

/// Returns the words that were coded, [receivers][layout.words], without loss. `layout` and `neighbors`
/// [receivers] must equal those passed to `encode_words`. Throws `Error` if it detects that the code is
/// damaged; some damage only changes the words. Every cluster index in the result is below
/// layout.clusters.size(). The caller must limit neighbors.size(), the number of receivers: a few bytes can
/// encode any number of equal receivers. Decodes blocks of 16384 receivers on `threads` threads; 0: all
/// hardware threads.
std::vector<std::uint32_t> decode_words(const WordCode& code, const WordLayout& layout,
                                        std::span<const EarlierNeighbors> neighbors, int threads = 0);

} // namespace prt
