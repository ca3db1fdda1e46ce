#pragma once

// The exceptions of prtkit. Stable.

#include <stdexcept>
#include <string>

namespace prt {

/// Base of all exceptions of prtkit. Thrown where input is checked. The message is one line that a user can
/// act on; it names the file and the location in it if there is one.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Thrown by long work after its `std::stop_token` requested a stop. Nothing has been written.
struct Cancelled : Error {
    Cancelled() : Error("cancelled") {}
};

/// Returns a library's message as one line: line breaks become spaces, trailing ones are removed.
std::string one_line(std::string message);

} // namespace prt
