#include "embedded_shaders.h"

#include "prt/error.h"

#include <set>
#include <sstream>

namespace prt {
namespace {

void append_file(const std::string& name, std::set<std::string>& included, std::string& source) {
    const auto found = embedded_files().find(name);
    if (found == embedded_files().end())
        throw Error("the shader " + name + " is not embedded");
    if (!included.insert(name).second)
        return;
    std::istringstream lines(found->second);
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view kInclude = "#include \"";
        if (line.starts_with(kInclude))
            append_file(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()), included, source);
        else
            source += line + "\n";
    }
}

} // namespace

std::string shader_source(std::string_view name, std::string_view defines) {
    std::string source = "#version 450 core\n";
    source += defines;
    std::set<std::string> included;
    append_file(std::string(name), included, source);
    return source;
}

} // namespace prt
