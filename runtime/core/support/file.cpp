// Reads complete files.
#include "runtime/core/support/file.h"

#include "prt/core/error.h"
#include "runtime/core/support/input_file.h"

namespace prt {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
    try {
        return InputFile(path).read_all();
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

} // namespace prt
