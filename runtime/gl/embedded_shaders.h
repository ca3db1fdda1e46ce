#pragma once

#include <map>
#include <string>
#include <string_view>

namespace prt {

/// The files of shaders/ that were embedded, by name.
const std::map<std::string, std::string>& embedded_files();

/// Source of a shader for OpenGL 4.5 core: #version, `defines` (lines), then the file with its includes in
/// place, each once. Throws `Error` for a file that is not embedded.
std::string shader_source(std::string_view name, std::string_view defines);

} // namespace prt
