#pragma once

// Compressed transfer (clustered PCA; Sloan, Hall, Hart and Snyder 2003): in memory, per frame, per receiver.
//
// Each frame, or each time the lighting changes:
//     former.form(light, constants);                       // M_k·L and B_kj·L: prt/constant_former.h
// then per receiver, in a vertex shader (shaders/prt_exit_radiance.glsl) or here:
//     R = C[first_k] + sum_i x_i C[first_k + 1 + i] + sum_j w_j C[first_k + 1 + g + j]
// docs/math.md, eq. 29, with C the constants and x the g coordinates of the guides, seen from their origin.
// Stable.

#include "prt/clustered_bases.h"
#include "prt/light.h"
#include "prt/support/glm_layout.h"
#include "prt/transfer.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// How weights are stored. Packed: cluster and weights share 32-bit words; a weight of b bits holds q = 0 ..
/// 2^b - 1 and means (2 q - (2^b - 1)) / (2^b - 1). Floats show the error without that rounding.
enum class WeightFormat { float32, packed };

/// Per receiver: its cluster and its weights, ready to be uploaded.
struct ClusteredReceivers {
    WeightFormat format = WeightFormat::float32;
    int components = 0;   ///< floats: weights stored per receiver, max m_k rounded up to a multiple of 4
    int cluster_bits = 0; ///< packed: the lowest bits of the first word, which hold the cluster
    int words = 0;        ///< packed: 32-bit words per receiver
    std::vector<std::uint16_t>
        clusters;                   ///< [receivers]; packed: the same as in the words, for use on the CPU
    std::vector<std::byte> weights; ///< [receivers][components] floats, unused ones 0; or [receivers][words]
    /// [receivers][guide rows]: coordinates of the guides, seen from their origins; a vertex shader has them
    /// from the mesh.
    std::vector<float> guides;

    std::size_t size() const { return clusters.size(); }
    /// Bytes of `weights` that one receiver has.
    std::size_t stride() const;
};

struct ClusteredTransfer {
    ClusteredBases bases;
    ClusteredReceivers receivers;
};

/// Writes the weights of a receiver, each in [-1, 1] unless the format is float, to `weights` [m_k].
void decode_weights(const ClusteredTransfer& transfer, std::span<const ClusterLayout> layouts,
                    std::size_t receiver, std::span<float> weights);

/// Packs a cluster and the integers q of its weights, in the bits that `layout` gives them, into `words`.
void pack_words(std::uint32_t cluster, int cluster_bits, const ClusterLayout& layout,
                std::span<const std::uint32_t> values, std::span<std::uint32_t> words);

/// Sets the clusters of `count` packed receivers from `first` on out of their words. Throws `Error` where
/// there is none such: "vertex 3 is in cluster 9 of 8", `what` being "vertex".
void unpack_clusters(std::size_t clusters, std::size_t first, std::size_t count, const char* what,
                     ClusteredReceivers& receivers);

/// Bytes that a game binds per receiver. Packed: whole 32-bit words. Floats: the cluster, padded to four
/// bytes as glTF asks of vertex attributes, and the weights as vectors of four.
std::size_t bytes_per_receiver(const ClusteredTransfer& transfer);

/// Bits of them that are in use in the cluster that uses most: the rest is zeros, which
/// EXT_meshopt_compression takes away on disk and nothing takes away in a vertex buffer.
std::size_t bits_per_receiver(const ClusteredTransfer& transfer);

/// Rows of constants: for each cluster a mean, three of each guide, and m_k directions.
std::size_t constant_rows(const ClusteredBases& bases);

/// Exit radiance for albedo 1 of every receiver, `radiance` [receivers], from formed constants: what the
/// vertex shader computes. Of transfer of several outputs, which has packed weights: [receivers][outputs].
void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads = 0);

/// Both steps at once.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Lighting& lighting,
                                     int threads = 0);
/// All light in one sky.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads = 0);

/// The transfer vectors that the compressed form stands for.
Transfer decode(const ClusteredTransfer& transfer, int threads = 0);

} // namespace prt
