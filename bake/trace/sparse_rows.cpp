// Multiplies sparse rows with transfer vectors in SIMD registers.

#include "bake/trace/sparse_rows.h"

#include "prt/core/sh_basis.h"
#include "runtime/core/support/vector_lanes.h"

#include <algorithm>

namespace prt {
namespace {

/// Computes sums += weight · values over `Length` values. Uses only whole registers; the last one overlaps
/// the previous one, so that there is no remainder.
template <int Length>
struct RegisterSums {
    static constexpr int kRegisters = (Length + kNarrow - 1) / kNarrow;
    Floats<kNarrow>::Value sums[kRegisters] = {};

    static constexpr int offset(int r) { return r + 1 < kRegisters ? r * kNarrow : Length - kNarrow; }
    [[gnu::always_inline]] void add(float weight, const float* values) {
        for (int r = 0; r < kRegisters; ++r)
            sums[r] += weight * floats_at<kNarrow>(values + offset(r));
    }
    [[gnu::always_inline]] void store(float* to) const {
        for (int r = 0; r < kRegisters; ++r)
            *reinterpret_cast<Floats<kNarrow>::InMemory*>(to + offset(r)) = sums[r];
    }
};
template <int Length>
requires(Length < kNarrow) struct RegisterSums<Length> {
    float sums[Length] = {};

    [[gnu::always_inline]] void add(float weight, const float* values) {
        for (int k = 0; k < Length; ++k)
            sums[k] += weight * values[k];
    }
    [[gnu::always_inline]] void store(float* to) const { std::copy_n(sums, Length, to); }
};

/// Multiplies a row with the matrix: `Groups` runs of `Length` values, with one weight each.
template <int Groups, int Length>
[[gnu::always_inline]] inline void apply_row(const SparseRow& row, const float* from, float* to) {
    RegisterSums<Length> sums[Groups];
    const float* weight = row.weights;
    const std::uint32_t* source = row.sources;
    for (std::uint32_t e = 0; e < row.count; ++e) {
        const float* values = from + static_cast<std::size_t>(source[e]) * (Groups * Length);
        for (int g = 0; g < Groups; ++g)
            sums[g].add(*weight++, values + g * Length);
    }
    for (int g = 0; g < Groups; ++g)
        sums[g].store(to + g * Length);
}

template <int Order>
[[gnu::always_inline]] inline void apply_rows_of_order(int channels, bool one_weight,
                                                       std::span<const SparseRow> rows, const float* from,
                                                       float* to) {
    constexpr int kCoefficients = coefficient_count(Order);
    for (const SparseRow& row : rows) {
        if (channels == 1)
            apply_row<1, kCoefficients>(row, from, to);
        else if (one_weight)
            apply_row<1, 3 * kCoefficients>(row, from, to);
        else
            apply_row<3, kCoefficients>(row, from, to);
        to += channels * kCoefficients;
    }
}

} // namespace

PRT_TARGET_CLONES
void apply_rows(int order, int channels, bool one_weight, std::span<const SparseRow> rows, const float* from,
                float* to) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            apply_rows_of_order<Order>(channels, one_weight, rows, from, to);
        });
}

} // namespace prt
