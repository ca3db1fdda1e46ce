#pragma once

// Foreign text in messages. Experimental.

#include <cstddef>
#include <string>
#include <string_view>

namespace prt {

/// Returns text from a file or a user in a form that is safe for a terminal and a log. UTF-8 is kept. Control
/// characters, invisible characters, characters that change the writing direction, and bytes that are not
/// UTF-8 become escapes (\x1b, \u202e). Text of more than `max_bytes` is truncated.
std::string printable(std::string_view text, std::size_t max_bytes = 1000);

} // namespace prt
