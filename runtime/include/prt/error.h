#pragma once

#include <stdexcept>

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

} // namespace prt
