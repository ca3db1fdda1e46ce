#pragma once

// Numbers with their nouns.

#include <cstddef>
#include <string>
#include <string_view>

namespace prt::cli {

/// Returns "1 sun", "2 suns" or "inf bounces". `many` is the plural; empty: `one` with "s".
inline std::string counted(std::string number, std::string_view one, std::string_view many = {}) {
    const bool single = number == "1";
    number += " ";
    if (single || many.empty())
        return number.append(one).append(single ? "" : "s");
    return number.append(many);
}
inline std::string counted(std::size_t number, std::string_view one, std::string_view many = {}) {
    return counted(std::to_string(number), one, many);
}

} // namespace prt::cli
