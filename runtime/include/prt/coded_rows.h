#pragma once

// Entropy-coded rows of small integers, which store the means and basis directions of clusters in a file
// (docs/format.md). Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Integers in rows, arithmetically coded. Row r stores its level t. Value i of that row then fits max(0, t -
/// drop[i]) bits of two's complement, which selects the models of its bits; a value of no bits is 0. Columns
/// that are small in all rows therefore cost few bits in every row.
struct RowCode {
    std::vector<std::uint8_t> drops; ///< [columns]
    std::vector<std::byte> bits;     ///< all rows, concatenated
};

inline constexpr int kMaxRowBits = 15; ///< widest value: -16384..16383

/// Returns the shortest code found for `values` [rows][columns], each in -16384..16383.
RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns);

/// Decodes `rows` rows. Throws `Error` if the bits end too early.
std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows);

} // namespace prt
