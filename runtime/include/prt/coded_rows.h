#pragma once

// Entropy-coded rows of small integers, which store the means and basis directions of clusters in a file
// (docs/format.md). Experimental.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Entropy code of a matrix of integers, [rows][columns]; the caller stores the number of rows. Each row
/// starts with its level, an integer in 0..15. In a row of level t, the value of column i fits max(0, t -
/// drops[i]) bits in two's complement; this number is the width of the value, and a value of width 0 is 0. A
/// large drop makes the values of a column cheap in every row, and limits their size.
struct RowCode {
    std::vector<std::uint8_t>
        drops; ///< [columns] number of bits by which column i is narrower than the level, 0..15
    std::vector<std::byte> bits; ///< levels and values of all rows in one arithmetic code
};

/// Maximum width of a coded value in bits: values are in -16384..16383.
inline constexpr int kMaxRowBits = 15;

/// Returns a code of `values` [rows][columns], which must be in -16384..16383. The number of rows is
/// values.size() / columns. The code is short, but the search for the best drops is not exhaustive.
RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns);

/// Returns the values of a code of `rows` rows, [rows][code.drops.size()]. Throws `Error` if `code.bits` is
/// too short for that number of rows. Does not detect other damage: the values of a damaged code can exceed
/// the width of their column.
std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows);

} // namespace prt
