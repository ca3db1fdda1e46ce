// Vectorised sums of outer products.

#include "bake/products/volumes/outer_sums.h"

#include "runtime/core/support/vector_lanes.h"

namespace prt {
namespace {

/// Adds a block. `values` is [count][columns], `sums` is [rows][columns]; columns are a multiple of
/// kLaneCount.
PRT_TARGET_CLONES
void add_block(const std::array<float, OuterSums::kMaxRows>* weights, const float* values, std::size_t count,
               std::size_t rows, std::size_t columns, float* sums) {
    for (std::size_t i = 0; i < columns; i += kLaneCount)
        for (std::size_t o = 0; o < rows; ++o) {
            Lanes sum = lanes_at(sums + o * columns + i);
            for (std::size_t r = 0; r < count; ++r)
                sum += weights[r][o] * lanes_at(values + r * columns + i);
            *reinterpret_cast<LanesInMemory*>(sums + o * columns + i) = sum;
        }
}

} // namespace

void OuterSums::begin(std::size_t rows, std::size_t columns) {
    rows_ = rows;
    columns_ = (columns + kLaneCount - 1) / kLaneCount * kLaneCount;
    count_ = 0;
    values_.assign(kAtOnce * columns_, 0.0f);
    sums_.assign(rows_ * columns_, 0.0f);
}

OuterSums::Room OuterSums::add() {
    if (count_ == kAtOnce)
        flush();
    const std::span<float> values = std::span(values_).subspan(count_ * columns_, columns_);
    return {std::span(weights_[count_++]).first(rows_), values};
}

std::span<const float> OuterSums::row(std::size_t row) {
    flush();
    return std::span(sums_).subspan(row * columns_, columns_);
}

void OuterSums::flush() {
    add_block(weights_.data(), values_.data(), count_, rows_, columns_, sums_.data());
    count_ = 0;
}

} // namespace prt
