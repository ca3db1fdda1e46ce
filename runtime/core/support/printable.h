#pragma once

// Escaping of text from files and users for messages. Experimental.

#include <cstddef>
#include <string>
#include <string_view>

namespace prt {

/// Returns `text` in a form that is safe for a terminal and a log. Visible UTF-8 characters and spaces are
/// kept. Control characters (including line breaks and tabs), common invisible characters, characters that
/// change the writing direction, code points from U+E0000, and bytes that are not valid UTF-8 become escapes
/// such as \x1b and \u202e. If the result becomes longer than `max_bytes` before the text ends, " ..."
/// replaces the rest of the text; the result can therefore have up to 12 bytes more than `max_bytes`.
std::string printable(std::string_view text, std::size_t max_bytes = 1000);

} // namespace prt
