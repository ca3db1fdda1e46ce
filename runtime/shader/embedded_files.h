#pragma once

// Access to the embedded shader files.

#include <map>
#include <string>

namespace prt {

/// Returns the embedded files of shaders/ by name.
const std::map<std::string, std::string>& embedded_files();

} // namespace prt
