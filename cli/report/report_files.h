#pragma once

#include <map>
#include <string>

namespace prt {

/// The files of cli/report/ that were embedded, by name.
const std::map<std::string, std::string>& report_files();

} // namespace prt
