// Formats messages of other libraries as one line.
#include "prt/core/error.h"

#include <algorithm>

namespace prt {

std::string one_line(std::string message) {
    while (!message.empty() && (message.back() == '\n' || message.back() == ' '))
        message.pop_back();
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message;
}

} // namespace prt
