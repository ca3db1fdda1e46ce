// Computes sums over square images; pixels that are mirrored in both axes share the basis values.
#include "runtime/core/light/square_sums.h"

#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"

#include <glm/geometric.hpp>

#include <cstring>

namespace prt {
namespace {

/// Half of the lanes: sums of four functions in three colors fit the registers.
using HalfLanes [[gnu::vector_size(sizeof(float) * kSumLanes)]] = float;

[[gnu::always_inline]] inline HalfLanes half_lanes_at(const float* values) {
    HalfLanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

/// Sums over the points of texels with few points.
PRT_TWO_CLONES
void sum_few_points(std::size_t functions, std::size_t points, std::size_t stride, const float* basis,
                    const float* weights, float* texels) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t x = 0; x < stride; x += kSumLanes) {
            HalfLanes sum{};
            for (std::size_t p = 0; p < points; ++p)
                sum += half_lanes_at(weights + p * stride + x) *
                       half_lanes_at(basis + (i * points + p) * stride + x);
            std::memcpy(texels + i * stride + x, &sum, sizeof sum);
        }
}

/// Sums in double over the points of large texels, which have hundreds.
void sum_many_points(std::size_t functions, std::size_t points, std::size_t stride, const float* basis,
                     const float* weights, float* texels) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t x = 0; x < stride; ++x) {
            double sum = 0;
            for (std::size_t p = 0; p < points; ++p)
                sum += static_cast<double>(weights[p * stride + x]) *
                       static_cast<double>(basis[(i * points + p) * stride + x]);
            texels[i * stride + x] = static_cast<float>(sum);
        }
}

} // namespace

void RowOfTexels::integrate(int order) {
    evaluate_sh(order, directions, basis);
    const auto sum = points <= 9 ? sum_few_points : sum_many_points;
    sum(static_cast<std::size_t>(coefficient_count(order)), points, stride, basis.data(), weights.data(),
        texels.data());
}

void fold(const glm::vec3* above, const glm::vec3* below, int size, int row, std::size_t stride,
          float* parts) {
    const float twice_y = 2 * row + 1 == size ? 0.5f : 1.0f; // the middle row mirrors itself
    for (int x = 0; 2 * x < size; ++x) {
        const float share = twice_y * (2 * x + 1 == size ? 0.5f : 1.0f);
        const int mirrored = size - 1 - x;
        for (int c = 0; c < 3; ++c) {
            const float a = above[x][c], b = above[mirrored][c], d = below[x][c], e = below[mirrored][c];
            float* to = parts + static_cast<std::size_t>(c) * stride + static_cast<std::size_t>(x);
            to[0] = share * ((a + b) + (d + e));
            to[3 * stride] = share * ((a - b) + (d - e));
            to[6 * stride] = share * ((a + b) - (d + e));
            to[9 * stride] = share * ((a - b) - (d - e));
        }
    }
}

namespace {

/// Adds the products of `Functions` functions with a part.
template <std::size_t Functions>
[[gnu::always_inline]] inline void multiply_term(const std::size_t* index, std::size_t stride,
                                                 const float* texels, const float* part, LaneSums& sums) {
    HalfLanes sum[Functions][3];
#pragma GCC unroll 4
    for (std::size_t f = 0; f < Functions; ++f)
#pragma GCC unroll 3
        for (std::size_t c = 0; c < 3; ++c)
            sum[f][c] = half_lanes_at(sums.at[index[f]][c]);
    for (std::size_t x = 0; x < stride; x += kSumLanes) {
        const HalfLanes red = half_lanes_at(part + x), green = half_lanes_at(part + stride + x),
                        blue = half_lanes_at(part + 2 * stride + x);
#pragma GCC unroll 4
        for (std::size_t f = 0; f < Functions; ++f) {
            const HalfLanes texel = half_lanes_at(texels + index[f] * stride + x);
            sum[f][0] += texel * red;
            sum[f][1] += texel * green;
            sum[f][2] += texel * blue;
        }
    }
#pragma GCC unroll 4
    for (std::size_t f = 0; f < Functions; ++f)
#pragma GCC unroll 3
        for (std::size_t c = 0; c < 3; ++c)
            std::memcpy(sums.at[index[f]][c], &sum[f][c], sizeof sum[f][c]);
}

} // namespace

PRT_TWO_CLONES
void multiply_parts(const BySigns& functions, std::size_t stride, const float* texels, const float* parts,
                    LaneSums& sums) {
    for (std::size_t p = 0; p < 4; ++p) {
        const float* part = parts + 3 * stride * p;
        std::size_t f = functions.first[p];
        for (; f + 4 <= functions.first[p + 1]; f += 4)
            multiply_term<4>(&functions.index[f], stride, texels, part, sums);
        for (; f < functions.first[p + 1]; ++f)
            multiply_term<1>(&functions.index[f], stride, texels, part, sums);
    }
}

PRT_TWO_CLONES
void multiply_all(const BySigns& functions, std::size_t stride, const float* texels, const float* part,
                  LaneSums& sums) {
    for (std::size_t f = 0; f < functions.first[4]; ++f)
        multiply_term<1>(&functions.index[f], stride, texels, part, sums);
}

void add_lanes(std::size_t functions, const LaneSums& sums, ProjectedColors& result) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t lane = 0; lane < kSumLanes; ++lane)
                result[i][static_cast<int>(c)] += static_cast<double>(sums.at[i][c][lane]);
}

void add_square(const ProjectedColors& square, const glm::dvec3& right, const glm::dvec3& down,
                const glm::dvec3& outward, int order, ProjectedColors& result) {
    // In a left-handed frame y changes its sign.
    const double hand = glm::dot(glm::cross(right, down), outward) < 0 ? -1 : 1;
    const ShRotation rotation(order, glm::dmat3(right, hand * down, outward));
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    for (int c = 0; c < 3; ++c) {
        std::array<double, kMaxOrder * kMaxOrder> in{}, out{};
        for (int l = 0; l < order; ++l)
            for (int m = -l; m <= l; ++m) {
                const auto i = static_cast<std::size_t>(sh_index(l, m));
                in[i] = m < 0 ? hand * square[i][c] : square[i][c];
            }
        rotation.apply(std::span<const double>(in), std::span<double>(out));
        for (std::size_t i = 0; i < count; ++i)
            result[i][c] += out[i];
    }
}

} // namespace prt
