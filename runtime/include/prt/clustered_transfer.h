#pragma once

// Compressed transfer (clustered PCA; Sloan, Hall, Hart and Snyder 2003): in memory, per frame, per receiver.
//
// Each frame, or each time the lighting changes:
//     form_constants(bases, light, constants);             // M_k·L and B_kj·L of all clusters
// then per receiver, in a vertex shader (shaders/prt_exit_radiance.glsl) or here:
//     R = constants[k][0] + sum_j w_j constants[k][1 + j]   // docs/math.md, eq. 14

#include "prt/light.h"
#include "prt/transfer.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Means and directions of all clusters.
struct ClusteredBases {
    int order = 0;
    int channels = 1;
    std::vector<int> components; ///< [clusters] number of directions m_k
    std::vector<float> rows;     ///< per cluster its mean, then its m_k directions; each [channels][order²]
    std::vector<float> scales;   ///< per cluster its m_k dequantisation scales: weight = scale · stored

    std::size_t clusters() const { return components.size(); }
    std::size_t dimension() const { return static_cast<std::size_t>(channels * coefficient_count(order)); }
    int max_components() const;
    /// Index of the first row of cluster `cluster` in `rows`; its scales start at first_row(k) - k. [clusters
    /// + 1]
    std::vector<std::size_t> first_rows() const;
};

/// How weights are stored. Normalised integers decode as in glTF and OpenGL: max(i / 127, -1), max(i / 32767,
/// -1).
enum class WeightFormat { float32, snorm16, snorm8 };

std::size_t bytes_per_weight(WeightFormat format);

/// Per receiver: its cluster and its weights, ready to be uploaded.
struct ClusteredReceivers {
    WeightFormat format = WeightFormat::float32;
    int components = 0; ///< weights stored per receiver: max m_k rounded up to a multiple of 4
    std::vector<std::uint16_t> clusters; ///< [receivers]
    std::vector<std::byte> weights;      ///< [receivers][components] of `format`; unused ones are 0

    std::size_t size() const { return clusters.size(); }
    /// The stored weight in [-1, 1] (or the float itself), before the scale.
    float weight(std::size_t receiver, int component) const;
};

struct ClusteredTransfer {
    ClusteredBases bases;
    ClusteredReceivers receivers;
};

/// What a game binds per receiver: its cluster in one byte, two above 256 clusters, and the weights in use.
std::size_t bytes_per_receiver(const ClusteredTransfer& transfer);

/// Means, directions and scales.
std::size_t basis_bytes(const ClusteredBases& bases);

/// Rows of constants per cluster: the mean and max_components() directions.
int constants_per_cluster(const ClusteredBases& bases);

/// Writes M_k·L and scale_kj B_kj·L to `constants` [clusters][constants_per_cluster] as (r, g, b, 0); rows
/// that a cluster does not have are 0. Allocates nothing when `light` has the order of the bases. Throws
/// `Error` if `light` has fewer bands.
void form_constants(const ClusteredBases& bases, const Light& light, std::span<glm::vec4> constants);

/// Exit radiance for albedo 1 of every receiver, `radiance` [receivers], from formed constants: what the
/// vertex shader computes.
void evaluate(const ClusteredReceivers& receivers, int constants_per_cluster,
              std::span<const glm::vec4> constants, std::span<glm::vec3> radiance, int threads = 0);

/// Both steps at once.
std::vector<glm::vec3> exit_radiance(const ClusteredTransfer& transfer, const Light& light, int threads = 0);

/// The transfer vectors that the compressed form stands for.
Transfer decode(const ClusteredTransfer& transfer);

} // namespace prt
