#pragma once

// Compressed transfer (clustered PCA; Sloan, Hall, Hart and Snyder 2003): its data in memory, and the work
// per frame and per receiver.
//
// Each frame, or each time the lighting changes:
//     relighter.update(light, constants); // constants C; `ClusterLighting` of prt/core/cluster_lighting.h
// Then per receiver, in a vertex shader (shaders/prt_exit_radiance.glsl) or on the CPU:
//     R = C[first_k] + sum_i x_i C[first_k + 1 + i] + sum_j w_j C[first_k + 1 + g + j]
// This is docs/math.md, eq. 29, with k the cluster of the receiver, m_k its number of basis directions,
// first_k the row of its mean, C the constants, and x the g predictor coordinates relative to their origin. w
// are the m_k weights; packed weights are used as the stored integers, because the constants contain their
// scale. Stable.

#include "prt/core/clustered_bases.h"
#include "prt/core/glm_layout.h"
#include "prt/core/light.h"
#include "prt/core/transfer.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Storage format of weights.
enum class WeightFormat {
    float32, ///< each weight is a float and is not rounded; serves to measure the error of packing
    packed   ///< cluster index and weights share 32-bit words. A weight of b bits is stored as an integer q
             ///< in 0 .. 2^b - 1 and has the value (2 q - (2^b - 1)) / (2^b - 1), in [-1, 1]
};

/// Cluster and weights of each receiver. `weights` is ready for upload to a vertex buffer.
struct ClusteredReceivers {
    WeightFormat format = WeightFormat::float32; ///< format of `weights`
    /// Format float32: number of weights stored per receiver, which is the maximum m_k over all clusters,
    /// rounded up to a multiple of 4. Format packed: not used.
    int components = 0;
    /// Format packed: number of bits for the cluster index, the lowest bits of a receiver's first word.
    /// Format float32: not used.
    int cluster_bits = 0;
    /// Format packed: number of 32-bit words per receiver, at least 1. Format float32: not used.
    int words = 0;
    /// Format float32: [receivers] index of each receiver's cluster. Format packed: empty, because the words
    /// contain the indices.
    std::vector<std::uint16_t> clusters;
    /// Format float32: floats [receivers][components]; the floats after the m_k weights of a receiver's
    /// cluster are 0. Format packed: 32-bit words [receivers][words] in the byte order of the CPU.
    std::vector<std::byte> weights;
    /// [receivers][`ClusteredBases::predictor_rows`] receiver coordinates minus `Predictor::origin`, not
    /// multiplied by `Predictor::scale`; empty without predictors. Only CPU code reads this array: a vertex
    /// shader takes normals and positions from the mesh. `load_model` leaves it empty; `add_coordinates` of
    /// prt/load/model.h fills it.
    std::vector<float> predictors;

    /// Returns the number of receivers.
    std::size_t size() const;
    /// Returns the number of bytes of one receiver in `weights`.
    std::size_t stride() const;
    /// Returns the index of the cluster of a receiver.
    std::size_t cluster(std::size_t receiver) const;
    /// Returns the indices of the clusters of all receivers, [receivers].
    std::vector<std::uint16_t> cluster_indices() const;
};

/// Compressed transfer.
struct ClusteredTransfer {
    ClusteredBases bases;         ///< rows and weight layout of all clusters
    ClusteredReceivers receivers; ///< cluster and weights of each receiver
};

/// Writes the m_k weights of receiver number `receiver`, with k its cluster, to the first m_k entries of
/// `weights`; `weights` may be longer. Packed weights become floats in [-1, 1]. `layouts` [clusters] is the
/// result of `cluster_layouts(transfer.bases)`.
void decode_weights(const ClusteredTransfer& transfer, std::span<const ClusterLayout> layouts,
                    std::size_t receiver, std::span<float> weights);

/// Packs the data of one receiver into `words` [ClusteredReceivers::words], from the lowest bit upwards:
/// first the index `cluster` in `cluster_bits` bits, then the integer weights `values` [m_k or more] in the
/// widths of `layout`, the layout of that cluster. Sets all other bits to 0. Each number must fit its width.
void pack_words(std::uint32_t cluster, int cluster_bits, const ClusterLayout& layout,
                std::span<const std::uint32_t> values, std::span<std::uint32_t> words);

/// Throws `Error` if the cluster index of a receiver in [first, first + count) is not below `clusters`, the
/// number of clusters. The message of the error names the receiver by the noun `what` and its number relative
/// to `first`: "vertex 3 has cluster 9, but there are only 8".
void check_clusters(std::size_t clusters, std::size_t first, std::size_t count, const char* what,
                    const ClusteredReceivers& receivers);

/// Returns the number of bytes that a game binds per receiver. Format packed: 4 bytes per word. Format
/// float32: 4 bytes for the cluster index, because glTF pads vertex attributes to four bytes, and 4 bytes for
/// each of the `components` weights.
std::size_t bytes_per_receiver(const ClusteredTransfer& transfer);

/// Returns the number of used bits per receiver, the maximum over all clusters. Format packed: bits of the
/// cluster index and of the m_k weights. All other bits of the words are 0: EXT_meshopt_compression removes
/// these bits in a file, but a vertex buffer contains them. Format float32: 8 bits for the cluster index, or
/// 16 bits for more than 256 clusters, and 32 bits for each of the m_k weights.
std::size_t bits_per_receiver(const ClusteredTransfer& transfer);

/// Returns the number of rows in all clusters together: per cluster one mean, three rows per predictor, and
/// m_k basis directions. For transfer with one output this is the number of constants.
std::size_t constant_rows(const ClusteredBases& bases);

/// Computes the exit radiance of every receiver for albedo 1 on the CPU, as the vertex shader does, and
/// writes it to `radiance` [receivers]. `constants` is the result of `ClusterLighting::update`. For transfer
/// with several outputs, writes the SH coefficients of incident light to `radiance` [receivers][outputs];
/// this transfer must have packed weights and no predictors. Transfer with predictors must have their
/// coordinates (ClusteredReceivers::predictors). Uses `threads` threads; 0: all hardware threads.
void evaluate(const ClusteredTransfer& transfer, std::span<const glm::vec4> constants,
              std::span<glm::vec3> radiance, int threads = 0);

/// Returns the exit radiance of every receiver for albedo 1 under `lighting`, [receivers]. `transfer` must
/// have one output. Throws `Error` if the layout of the transfer is invalid (`check_layout`), if the sky or
/// the suns have fewer bands than the transfer, or if `lighting.lamps` is not empty and its length differs
/// from the number of lamps of the transfer. Uses `threads` threads; 0: all hardware threads.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Lighting& lighting,
                                     int threads = 0);
/// Returns the exit radiance of every receiver for albedo 1, [receivers], under the sky `light`, without
/// separate suns and with all lamps at strength 1. `transfer` must have one output. Throws `Error` if the
/// layout of the transfer is invalid (`check_layout`), or if `light` has fewer bands than the transfer. Uses
/// `threads` threads; 0: all hardware threads.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads = 0);

/// Returns the decompressed transfer vectors of all receivers, in the layout of `transfer.bases`. The vectors
/// contain the error of the compression. Uses `threads` threads; 0: all hardware threads.
Transfer decode(const ClusteredTransfer& transfer, int threads = 0);

} // namespace prt
