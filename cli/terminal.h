#pragma once

// All that the program prints. Nothing here throws where a stream is closed or full, but for `flush_output`,
// and nothing that a terminal would act on gets through, whatever files are called and hold.

#include <string>
#include <string_view>

namespace prt::cli {

/// Lets nothing that is opened later get the number of a standard stream that was closed: what is printed
/// there is lost, and does not end in an output.
void occupy_standard_streams();

/// On stdout, lines and all.
void print(std::string_view text);
/// Throws `Error` where some of what was printed did not arrive.
void flush_output();

/// One line on stderr, after "prt: ".
void say(std::string_view what);
/// Progress on stderr, with what moves a terminal's cursor.
void show(const std::string& text);

} // namespace prt::cli
