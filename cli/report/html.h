#pragma once

#include <string>
#include <string_view>

namespace prt::cli {

std::string html_escaped(std::string_view text);

} // namespace prt::cli
