// Constants of all clusters as one product of a matrix, 16 rows wide, with the lighting.
#include "prt/constant_former.h"

#include "prt/support/error.h"
#include "prt/support/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string>

namespace prt {
namespace {

constexpr std::size_t kLanes = kLaneCount;

/// A lighting, its channels apart.
struct Channels {
    std::size_t count; ///< coefficients of each
    std::array<const float*, 3> light;
};

/// Blocks of kLanes rows.
struct Blocks {
    std::size_t first, last;
};

template <std::size_t Stored>
[[gnu::always_inline]] inline void form_blocks(const float* matrix, const Channels& channels,
                                               const Blocks& blocks, std::size_t rows, glm::vec4* constants) {
    const std::size_t count = channels.count;
    const std::array<const float*, 3> light = channels.light;
    for (std::size_t block = blocks.first; block < blocks.last; ++block) {
        const float* from = matrix + block * Stored * count * kLanes;
        Lanes color[3] = {};
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                color[c] += lanes_at(from + ((Stored == 1 ? 0 : c) * count + i) * kLanes) * light[c][i];
        const std::size_t kept = std::min(kLanes, rows - block * kLanes);
        for (std::size_t lane = 0; lane < kept; ++lane)
            constants[block * kLanes + lane] = {color[0][lane], color[1][lane], color[2][lane], 0};
    }
}

PRT_TARGET_CLONES
void form_rows(int stored, const float* matrix, const Channels& channels, const Blocks& blocks,
               std::size_t rows, glm::vec4* constants) {
    if (stored == 1)
        form_blocks<1>(matrix, channels, blocks, rows, constants);
    else
        form_blocks<3>(matrix, channels, blocks, rows, constants);
}

/// Rows by which the stored weights are multiplied. A packed weight is w = 2 q / largest - 1, so that
/// mean + sum w_j row_j = (mean - sum row_j) + sum q_j (2 / largest_j) row_j.
std::vector<float> rows_of_stored(const ClusteredTransfer& transfer) {
    const ClusteredBases& bases = transfer.bases;
    std::vector<float> rows = bases.rows;
    if (transfer.receivers.format != WeightFormat::packed)
        return rows;
    const std::size_t dimension = bases.dimension();
    const std::uint8_t* bits = bases.bits.data();
    float* mean = rows.data();
    for (const int components : bases.components) {
        float* row = mean + dimension;
        for (int j = 0; j < components; ++j, row += dimension) {
            const float scale = 2 / static_cast<float>((1u << *bits++) - 1);
            for (std::size_t i = 0; i < dimension; ++i) {
                mean[i] -= row[i];
                row[i] *= scale;
            }
        }
        mean = row;
    }
    return rows;
}

} // namespace

ConstantFormer::ConstantFormer(const ClusteredTransfer& transfer)
    : order_(transfer.bases.order), channels_(transfer.bases.channels), rows_(constant_rows(transfer.bases)) {
    const std::vector<float> rows = rows_of_stored(transfer);
    const std::size_t dimension = transfer.bases.dimension();
    matrix_.assign((rows_ + kLanes - 1) / kLanes * kLanes * dimension, 0.0f);
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t i = 0; i < dimension; ++i)
            matrix_[(row / kLanes * dimension + i) * kLanes + row % kLanes] = rows[row * dimension + i];
}

void ConstantFormer::form(std::span<const glm::vec3> light, std::span<glm::vec4> constants) const {
    form(light, constants, 0, rows_);
}

void ConstantFormer::form(std::span<const glm::vec3> light, std::span<glm::vec4> constants, std::size_t first,
                          std::size_t last) const {
    const auto count = static_cast<std::size_t>(coefficient_count(order_));
    if (light.size() < count)
        throw Error("the lighting has " + std::to_string(light.size()) + " coefficients, transfer of order " +
                    std::to_string(order_) + " needs " + std::to_string(count));
    assert(constants.size() >= rows_);
    std::array<std::array<float, kMaxOrder * kMaxOrder>, 3> separate;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            separate[c][i] = light[i][static_cast<int>(c)];
    form_rows(channels_, matrix_.data(),
              {count, {separate[0].data(), separate[1].data(), separate[2].data()}},
              {first / kLanes, (std::min(last, rows_) + kLanes - 1) / kLanes}, rows_, constants.data());
}

void blend_constants(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float share,
                     std::span<glm::vec4> out) {
    assert(a.size() == b.size() && a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = a[i] + share * (b[i] - a[i]);
}

} // namespace prt
