#pragma once

// Compressed transfer (clustered PCA; Sloan, Hall, Hart and Snyder 2003): its data in memory, and the work
// per frame and per receiver.
//
// Each frame, or each time the lighting changes:
//     relighter.update(light, constants);                       // M_k·L and B_kj·L: prt/cluster_lighting.h
// Then per receiver, in a vertex shader (shaders/prt_exit_radiance.glsl) or on the CPU:
//     R = C[first_k] + sum_i x_i C[first_k + 1 + i] + sum_j w_j C[first_k + 1 + g + j]
// This is docs/math.md, eq. 29, with C the constants and x the g predictor coordinates relative to their
// origin. Stable.

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

/// Storage format of weights. `packed`: cluster and weights share 32-bit words; a weight of b bits is stored
/// as an integer q = 0 .. 2^b - 1 and has the value (2 q - (2^b - 1)) / (2^b - 1). `float32`: weights are not
/// rounded, to measure the error without that rounding.
enum class WeightFormat { float32, packed };

/// Cluster and weights of each receiver, ready for upload.
struct ClusteredReceivers {
    WeightFormat format = WeightFormat::float32;
    int components = 0;   ///< float32: weights stored per receiver, max m_k rounded up to a multiple of 4
    int cluster_bits = 0; ///< packed: number of lowest bits of the first word that hold the cluster
    int words = 0;        ///< packed: 32-bit words per receiver
    std::vector<std::uint16_t> clusters; ///< [receivers]; packed: copy of the clusters in the words, for use
                                         ///< on the CPU
    std::vector<std::byte> weights; ///< [receivers][components] floats, unused ones 0; or [receivers][words]
    /// [receivers][predictor rows] predictor coordinates relative to their origins. A vertex shader takes
    /// them from the mesh.
    std::vector<float> predictors;

    std::size_t size() const { return clusters.size(); }
    /// Size of one receiver's entry in `weights` in bytes.
    std::size_t stride() const;
};

/// Compressed transfer: the bases of all clusters, and the cluster and weights of each receiver.
struct ClusteredTransfer {
    ClusteredBases bases;
    ClusteredReceivers receivers;
};

/// Writes the weights of `receiver` to `weights` [m_k]. Packed weights are in [-1, 1]. `layouts` is the
/// result of `cluster_layouts`.
void decode_weights(const ClusteredTransfer& transfer, std::span<const ClusterLayout> layouts,
                    std::size_t receiver, std::span<float> weights);

/// Packs a cluster index and the weights `values`, as integers q, into `words` with the bit widths of
/// `layout`.
void pack_words(std::uint32_t cluster, int cluster_bits, const ClusterLayout& layout,
                std::span<const std::uint32_t> values, std::span<std::uint32_t> words);

/// Reads the clusters of `count` packed receivers, starting at `first`, from their words. Throws `Error` if a
/// cluster does not exist. `what` names a receiver in that message: "vertex 3 is in cluster 9 of 8".
void unpack_clusters(std::size_t clusters, std::size_t first, std::size_t count, const char* what,
                     ClusteredReceivers& receivers);

/// Returns the number of bytes that a game binds per receiver. Packed: whole 32-bit words. Floats: the
/// cluster, padded to four bytes as glTF requires for vertex attributes, and the weights as vectors of four.
std::size_t bytes_per_receiver(const ClusteredTransfer& transfer);

/// Returns the number of used bits per receiver, the maximum over all clusters. All other bits are zero.
/// EXT_meshopt_compression removes them on disk; in a vertex buffer they remain.
std::size_t bits_per_receiver(const ClusteredTransfer& transfer);

/// Returns the number of rows of constants: per cluster one mean, three rows per predictor, and m_k basis
/// directions.
std::size_t constant_rows(const ClusteredBases& bases);

/// Computes the exit radiance of every receiver for albedo 1 from the result of `ClusterLighting::update`, as
/// the vertex shader does, and writes it to `radiance` [receivers]. Transfer with several outputs requires
/// packed weights; `radiance` is then [receivers][outputs].
void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads = 0);

/// Computes the exit radiance of every receiver for albedo 1 under `lighting`, [receivers]. Throws `Error` if
/// the lighting has too few bands.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Lighting& lighting,
                                     int threads = 0);
/// Computes the exit radiance of every receiver for albedo 1, [receivers], under the sky `light` without
/// separate suns; lamps have the strength 1.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads = 0);

/// Returns the decompressed transfer vectors.
Transfer decode(const ClusteredTransfer& transfer, int threads = 0);

} // namespace prt
