#pragma once

// Mapping from light columns to the coefficients of one color.

#include "prt/core/transfer_layout.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace prt {

/// Returns for each column of light the index of the transfer coefficient that its color `c` is multiplied
/// with: [layout.columns()]. A single channel is used for all colors.
inline std::vector<std::size_t> numbers_of_color(const TransferLayout& layout, int c) {
    std::vector<std::size_t> numbers;
    std::size_t begin = 0;
    for (const TransferTerm& term : layout.terms) {
        const std::size_t first =
            begin + static_cast<std::size_t>(std::min(c, term.channels - 1)) * layout.columns_of(term);
        for (std::size_t i = 0; i < layout.columns_of(term); ++i)
            numbers.push_back(first + i);
        begin += layout.numbers_of(term);
    }
    return numbers;
}

} // namespace prt
