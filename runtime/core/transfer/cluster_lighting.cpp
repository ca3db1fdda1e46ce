// Computes the constants of all clusters as the product of a matrix, blocked by 16 rows, with the lighting.
#include "prt/core/cluster_lighting.h"

#include "runtime/core/support/vector_lanes.h"
#include "runtime/core/transfer/evaluate_range.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace prt {
namespace {

/// Range of blocks of kLaneCount rows.
struct Blocks {
    std::size_t first, last;
};

using Narrow = Floats<kNarrow>::Value;

/// Colors of kNarrow rows, in two sums without a dependency on each other.
struct ColorSums {
    Narrow even[3], odd[3];
};

/// Adds the products of a term, [Stored][count][kLaneCount], with its light, [3][count].
template <std::size_t Stored>
[[gnu::always_inline]] inline void add_term(const float* from, const float* light, std::size_t count,
                                            ColorSums& sums) {
    const auto product = [&](std::size_t c, std::size_t i) __attribute__((always_inline)) {
        return floats_at<kNarrow>(from + ((Stored == 1 ? 0 : c) * count + i) * kLaneCount) *
               light[c * count + i];
    };
    std::size_t i = 0;
    for (; i + 2 <= count; i += 2)
        for (std::size_t c = 0; c < 3; ++c) {
            sums.even[c] += product(c, i);
            sums.odd[c] += product(c, i + 1);
        }
    if (i < count)
        for (std::size_t c = 0; c < 3; ++c)
            sums.even[c] += product(c, i);
}

/// Computes up to kNarrow rows. `light`: for each term [3][its columns]. `matrix`: coefficients of the first
/// row.
[[gnu::always_inline]] inline void update_some(const TransferLayout& layout, const float* matrix,
                                               const float* light, std::size_t rows, glm::vec4* constants) {
    ColorSums sums = {};
    for (const TransferTerm& term : layout.terms) {
        const std::size_t count = layout.columns_of(term);
        if (term.channels == 1)
            add_term<1>(matrix, light, count, sums);
        else
            add_term<3>(matrix, light, count, sums);
        matrix += layout.numbers_of(term) * kLaneCount;
        light += 3 * count;
    }
    for (std::size_t lane = 0; lane < std::min<std::size_t>(kNarrow, rows); ++lane)
        constants[lane] = {sums.even[0][lane] + sums.odd[0][lane], sums.even[1][lane] + sums.odd[1][lane],
                           sums.even[2][lane] + sums.odd[2][lane], 0};
}

PRT_TWO_CLONES
void update_rows(const TransferLayout& layout, const float* matrix, const float* light, const Blocks& blocks,
                 std::size_t rows, glm::vec4* constants) {
    for (std::size_t block = blocks.first; block < blocks.last; ++block)
        for (std::size_t row = block * kLaneCount; row < std::min(rows, (block + 1) * kLaneCount);
             row += kNarrow)
            update_some(layout, matrix + block * layout.dimension() * kLaneCount + row % kLaneCount, light,
                        rows - row, constants + row);
}

/// Returns the rows by which predictor coordinates and stored weights are multiplied. A packed weight is w =
/// 2 q / largest - 1, so that mean + sum w_j row_j = (mean - sum row_j) + sum q_j (2 / largest_j) row_j.
std::vector<float> rows_of_stored(const ClusteredTransfer& transfer) {
    const ClusteredBases& bases = transfer.bases;
    const bool packed = transfer.receivers.format == WeightFormat::packed;
    std::vector<float> rows = bases.rows;
    const std::size_t dimension = bases.dimension();
    const std::uint8_t* bits = bases.bits.data();
    const std::int32_t* center = bases.centers.data();
    float* mean = rows.data();
    for (const int components : bases.components) {
        float* row = mean + dimension;
        const auto fold = [&](float offset, float scale) {
            for (std::size_t i = 0; i < dimension; ++i) {
                mean[i] -= offset * row[i];
                row[i] *= scale;
            }
            row += dimension;
        };
        for (std::size_t g = 0; g < bases.predictor_rows(); ++g)
            fold(static_cast<float>(*center++), bases.predictor_scale(g));
        for (int j = 0; j < components; ++j)
            fold(packed ? 1.0f : 0.0f, packed ? 2 / static_cast<float>((1u << *bits++) - 1) : 1.0f);
        mean = row;
    }
    return rows;
}

} // namespace

ClusterLighting::ClusterLighting(const ClusteredTransfer& transfer)
    : layout_(transfer.bases.layout.of_one_output()),
      rows_(constant_rows(transfer.bases) * transfer.bases.layout.outputs) {
    check_layout(transfer.bases.layout);
    check_rows(transfer.bases);
    const std::vector<float> rows = rows_of_stored(transfer); // all outputs, one after another
    const std::size_t dimension = layout_.dimension();
    matrix_.assign((rows_ + kLaneCount - 1) / kLaneCount * kLaneCount * dimension, 0.0f);
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t i = 0; i < dimension; ++i)
            matrix_[(row / kLaneCount * dimension + i) * kLaneCount + row % kLaneCount] =
                rows[row * dimension + i];
}

void ClusterLighting::update(const LightingView& lighting, std::span<glm::vec4> constants) const {
    update(lighting, constants, 0, rows_);
}

void ClusterLighting::update(const LightingView& lighting, std::span<glm::vec4> constants, std::size_t first,
                             std::size_t last) const {
    assert(constants.size() >= rows_);
    std::array<glm::vec3, kMaxLightColumns> columns;
    write_light_columns(layout_, lighting, columns);
    std::array<float, 3 * kMaxLightColumns> separate;
    auto to = separate.begin();
    const glm::vec3* color = columns.data();
    for (const TransferTerm& term : layout_.terms) {
        const std::size_t count = layout_.columns_of(term);
        for (int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < count; ++i)
                *to++ = color[i][c];
        color += count;
    }
    update_rows(layout_, matrix_.data(), separate.data(),
                {first / kLaneCount, (std::min(last, rows_) + kLaneCount - 1) / kLaneCount}, rows_,
                constants.data());
}

void free_rows(ClusteredTransfer& transfer) {
    transfer.bases.rows = {};
    transfer.bases.coded = {};
}

void blend_constants(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float share,
                     std::span<glm::vec4> out) {
    assert(a.size() == b.size() && a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = a[i] + share * (b[i] - a[i]);
}

} // namespace prt
