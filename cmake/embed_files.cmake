# Run as a script: writes FILES into the C++ source OUTPUT as raw string literals.
set(entries "")
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from shaders/ by cmake/embed_files.cmake.
#include \"embedded_files.h\"

namespace prt {
const std::map<std::string, std::string>& embedded_files() {
    static const std::map<std::string, std::string> files = {
${entries}    };
    return files;
}
} // namespace prt
")
