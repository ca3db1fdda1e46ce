#pragma once

// Singular and plural in messages. Experimental.

#include <concepts>
#include <string>
#include <string_view>

namespace prt {

/// Returns the number with the noun in the matching form: "1 sun", "2 suns". Without `many`, the plural is
/// `one` with an "s". Both can contain a verb: `counted(n, "sun is", "suns are")`.
template <std::integral Count>
std::string counted(Count count, std::string_view one, std::string_view many = {}) {
    std::string text = std::to_string(count) + ' ';
    if (count == 1)
        return text.append(one);
    return many.empty() ? text.append(one) + 's' : text.append(many);
}

} // namespace prt
