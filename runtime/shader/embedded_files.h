#pragma once

#include <map>
#include <string>

namespace prt {

/// The files of shaders/ that were embedded, by name.
const std::map<std::string, std::string>& embedded_files();

} // namespace prt
