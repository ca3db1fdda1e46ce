// Computes the directions of a chunk of rays and the sum of their basis functions with SIMD registers.

#include "bake/trace/chunk_kernels.h"

#include "prt/core/sh_basis.h"
#include "runtime/core/support/vector_lanes.h"

#include <cassert>
#include <cmath>

namespace prt {
namespace {

/// Converts to [-1, 1): uses the upper 24 bits and the center of their interval, so that neither end is
/// reached.
[[gnu::always_inline]] inline float to_signed_unit(std::uint32_t v) {
    return (static_cast<float>(static_cast<std::int32_t>(v >> 8)) + 0.5f) * 0x1p-23f - 1.0f;
}

template <int Order>
[[gnu::always_inline]] inline void basis_of_packet(const ChunkDirections& directions, std::size_t first,
                                                   Lanes* basis) {
    const Lanes x = lanes_at(&directions.x[first]), y = lanes_at(&directions.y[first]),
                z = lanes_at(&directions.z[first]);
    sh_basis<Order>(x, y, z, basis);
}

template <int Order>
[[gnu::always_inline]] inline void add_basis_of_order(const ChunkDirections& directions, int count,
                                                      const float* weights, double* sums) {
    constexpr int kCoefficients = coefficient_count(Order);
    Lanes total[kCoefficients] = {}, basis[kCoefficients];
    const int whole = count / kPacket * kPacket;
    for (int i = 0; i < whole; i += kPacket) {
        basis_of_packet<Order>(directions, static_cast<std::size_t>(i), basis);
        if (weights) {
            const Lanes weight = lanes_at(weights + i);
            for (int k = 0; k < kCoefficients; ++k)
                total[k] += weight * basis[k];
        } else {
            for (int k = 0; k < kCoefficients; ++k)
                total[k] += basis[k];
        }
    }
    if (whole < count) {
        basis_of_packet<Order>(directions, static_cast<std::size_t>(whole), basis);
        Lanes used = {};
        for (int lane = 0; lane < count - whole; ++lane)
            used[lane] = weights ? weights[whole + lane] : 1.0f;
        for (int k = 0; k < kCoefficients; ++k)
            total[k] += used * basis[k];
    }
    for (int k = 0; k < kCoefficients; ++k)
        for (int lane = 0; lane < kPacket; ++lane)
            sums[k] += static_cast<double>(total[k][lane]);
}

} // namespace

PRT_TARGET_CLONES
void generate_directions(const SobolChunk& chunk, SobolOffset offset, std::uint32_t seed,
                         const TangentFrame& frame, ChunkDirections& directions) {
    const std::uint32_t seed_x = pcg_hash(seed), seed_y = pcg_hash(seed ^ 0x9e3779b9u);
    const std::uint32_t* sobol_x = chunk.x.data();
    const std::uint32_t* sobol_y = chunk.y.data();
    const glm::vec3 t = frame.tangent, b = frame.bitangent, n = frame.normal;
    float* const to_x = directions.x.data(); // plain pointers: through std::array the loop does not vectorise
    float* const to_y = directions.y.data();
    float* const to_z = directions.z.data();
    const std::size_t count = chunk.x.size();
    for (std::size_t i = 0; i < count; ++i) {
        const float u = to_signed_unit(reverse_bits(laine_karras(sobol_x[i] ^ offset.x, seed_x)));
        const float v = to_signed_unit(reverse_bits(laine_karras(sobol_y[i] ^ offset.y, seed_y)));
        // Concentric map: the radius is the larger coordinate, the angle is pi/4 times the ratio. Sine and
        // cosine by their Taylor series, whose remainder on [-pi/4, pi/4] is below float rounding (3e-8
        // relative).
        const bool wide = std::fabs(u) > std::fabs(v);
        const float radius = wide ? u : v;
        const float angle = 0.785398163f * (wide ? v : u) / radius;
        const float a2 = angle * angle;
        const float sine =
            angle * (1 + a2 * (-1.0f / 6 + a2 * (1.0f / 120 + a2 * (-1.0f / 5040 + a2 * (1.0f / 362880)))));
        const float cosine = 1 + a2 * (-0.5f + a2 * (1.0f / 24 + a2 * (-1.0f / 720 + a2 * (1.0f / 40320))));
        const float x = radius * (wide ? cosine : sine), y = radius * (wide ? sine : cosine);
        const float z = std::sqrt(1 - radius * radius); // the radius is at most 1
        to_x[i] = t.x * x + b.x * y + n.x * z;
        to_y[i] = t.y * x + b.y * y + n.y * z;
        to_z[i] = t.z * x + b.z * y + n.z * z;
    }
}

PRT_TARGET_CLONES
void add_basis(int order, const ChunkDirections& directions, int count, const float* weights,
               std::span<double> sums) {
    assert(order >= 1 && order <= kMaxOrder && count <= kChunk);
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            add_basis_of_order<Order>(directions, count, weights, sums.data());
        });
}

} // namespace prt
