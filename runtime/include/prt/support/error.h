#pragma once

// What is thrown. Stable.

#include <stdexcept>
#include <string>

namespace prt {

/// The one exception of prtkit. Thrown where input enters; the message is one line that a user can act on and
/// names the file and the place in it where there is one.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Thrown by long work when its `std::stop_token` was asked to stop. Nothing has been written.
struct Cancelled : Error {
    Cancelled() : Error("cancelled") {}
};

/// A library's message as one line: line ends become spaces, those at the end go.
std::string one_line(std::string message);

} // namespace prt
