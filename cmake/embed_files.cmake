# Run as a script: writes FILES into the C++ source OUTPUT as raw string literals, which FUNCTION of HEADER returns by
# name.
set(entries "")
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by cmake/embed_files.cmake.
#include \"${HEADER}\"

namespace prt {
const std::map<std::string, std::string>& ${FUNCTION}() {
    static const std::map<std::string, std::string> files = {
${entries}    };
    return files;
}
} // namespace prt
")
