#pragma once

// All output to the terminal. No function throws if a stream is closed or full, except `flush_output`. No
// control sequence reaches the terminal, whichever names and contents files have.

#include <string>
#include <string_view>

namespace prt::cli {

/// Prevents that files opened later get the number of a standard stream that was closed: text printed there
/// is lost, and does not end up in an output file.
void occupy_standard_streams();

/// Prints to stdout, including line breaks.
void print(std::string_view text);
/// Throws `Error` if some printed text did not arrive.
void flush_output();

/// Prints one line on stderr, after "prt: ".
void say(std::string_view what);
/// Shows progress on stderr, with control characters that move the cursor.
void show(const std::string& text);

} // namespace prt::cli
