#pragma once

// The exceptions that functions of prtkit throw. Stable.

#include <stdexcept>
#include <string>

namespace prt {

/// Exception for invalid input and for failed operations, for example on files; base of all exceptions of
/// prtkit. `what()` is one line that a user can act on. A message about a file names the file and, if known,
/// the position in the file.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Exception of a long operation, such as a bake, that ended early because a stop was requested from the
/// `std::stop_token` of its `Progress` (prt/core/progress.h). The operation has then written no file.
struct Cancelled : Error {
    Cancelled() : Error("cancelled") {}
};

/// Returns `message`, for example of another library, as one line: removes line feeds and spaces at the end,
/// and replaces each other line feed by a space.
std::string one_line(std::string message);

} // namespace prt
