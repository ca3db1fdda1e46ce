#pragma once

// Singular and plural in messages. Experimental.

#include <concepts>
#include <string>
#include <string_view>

namespace prt {

/// Returns `count`, a space and a noun in the matching form: "1 sun", "2 suns". Uses the singular `one` if
/// count is 1, else the plural `many`. If `many` is empty (the default), the plural is `one` with an "s"
/// appended. The forms can contain a verb: `counted(n, "sun is", "suns are")`.
template <std::integral Count>
std::string counted(Count count, std::string_view one, std::string_view many = {}) {
    std::string text = std::to_string(count) + ' ';
    if (count == 1)
        return text.append(one);
    return many.empty() ? text.append(one) + 's' : text.append(many);
}

} // namespace prt
