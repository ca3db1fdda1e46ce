#pragma once

// Pieces that report pages share. Pages stand alone: no scripts, nothing loaded.

#include <string>
#include <string_view>

namespace prt::cli {

std::string html_escaped(std::string_view text);

/// Everything up to and with the heading.
std::string html_begin(std::string_view title, std::string_view heading);
std::string html_end();

} // namespace prt::cli
