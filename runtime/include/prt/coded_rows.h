#pragma once

// Rows of numbers in few bits: how a file keeps the means and directions of its clusters (docs/format.md).
// Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Integers in rows of a few widths, arithmetically coded. Row r stores its level t; value i then fits max(0,
/// t - drop[i]) bits of two's complement, which is what the models of its bits go by; no bits: 0. Columns
/// that are small everywhere so cost little in every row.
struct RowCode {
    std::vector<std::uint8_t> drops; ///< [columns]
    std::vector<std::byte> bits;     ///< all rows one after the other
};

inline constexpr int kMostRowBits = 15; ///< widest value: -16384..16383

/// The shortest code of `values` [rows][columns], each in -16384..16383.
RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns);

/// The values of `rows` rows. Throws `Error` where the bits end too early.
std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows);

} // namespace prt
