#pragma once

// Foreign text in messages. Experimental.

#include <cstddef>
#include <string>
#include <string_view>

namespace prt {

/// Text from a file or a user as a terminal and a log can take it: UTF-8 stays; control characters, those
/// that are not seen or turn the direction of writing, and bytes that are no UTF-8 become escapes (\x1b,
/// \u202e), and a text of more than `most_bytes` is cut.
std::string printable(std::string_view text, std::size_t most_bytes = 1000);

} // namespace prt
