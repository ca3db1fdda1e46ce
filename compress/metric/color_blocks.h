#pragma once

// Which numbers of a transfer vector serve a color.

#include "prt/transfer_layout.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace prt {

/// Of each column of light in turn, the number of a transfer vector that color `c` of it is multiplied with:
/// [layout.columns()]. One channel serves all colors.
inline std::vector<std::size_t> numbers_of_color(const TransferLayout& layout, int c) {
    std::vector<std::size_t> numbers;
    std::size_t begin = 0;
    for (const TransferPart& part : layout.parts) {
        const std::size_t first =
            begin + static_cast<std::size_t>(std::min(c, part.channels - 1)) * layout.columns_of(part);
        for (std::size_t i = 0; i < layout.columns_of(part); ++i)
            numbers.push_back(first + i);
        begin += layout.numbers_of(part);
    }
    return numbers;
}

} // namespace prt
