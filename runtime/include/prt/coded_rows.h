#pragma once

// Entropy-coded rows of small integers, which store the means and basis directions of clusters in a file
// (docs/format.md). Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Rows of integers in an arithmetic code. Row r stores its level t. Value i of the row then fits max(0, t -
/// drops[i]) bits of two's complement. This width also selects the probability models of the bits. A value of
/// width 0 is 0. Columns that are small in all rows therefore cost few bits in every row.
struct RowCode {
    std::vector<std::uint8_t> drops; ///< [columns]
    std::vector<std::byte> bits;     ///< all rows, concatenated
};

inline constexpr int kMaxRowBits = 15; ///< widest value: -16384..16383

/// Codes `values` [rows][columns], each in -16384..16383. Returns the shortest code that is found.
RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns);

/// Decodes `rows` rows: [rows][columns]. Throws `Error` if the bits end too early.
std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows);

} // namespace prt
