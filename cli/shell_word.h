#pragma once

#include <string>
#include <string_view>

namespace prt::cli {

/// A word as a shell takes it for one: in quotes where it needs them.
std::string shell_word(std::string_view word);

} // namespace prt::cli
