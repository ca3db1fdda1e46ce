#pragma once

#include <string>
#include <string_view>

namespace prt::pipeline {

/// Returns a word quoted for a shell, if it needs quotes.
std::string shell_word(std::string_view word);

} // namespace prt::pipeline
