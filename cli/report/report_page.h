#pragma once

#include <map>
#include <string>

namespace prt::cli {

/// cli/report/page.html with {{name}} replaced by the part of that name, which is HTML already.
std::string filled_page(const std::map<std::string, std::string>& parts);

} // namespace prt::cli
