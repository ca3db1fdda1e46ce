// Reading files whole.
#include "prt/support/file.h"

#include "prt/support/error.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace prt {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
    std::error_code status;
    if (std::filesystem::is_directory(path, status))
        throw Error(path.string() + ": is a directory");
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw Error(path.string() + ": " + std::strerror(errno));
    std::vector<std::byte> bytes;
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    for (std::size_t read = 0;;) {
        bytes.resize(read + kBlock);
        file.read(reinterpret_cast<char*>(bytes.data() + read), static_cast<std::streamsize>(kBlock));
        read += static_cast<std::size_t>(file.gcount());
        if (file)
            continue;
        if (file.bad())
            throw Error(path.string() + ": cannot be read");
        bytes.resize(read);
        break;
    }
    if (bytes.empty())
        throw Error(path.string() + ": the file is empty");
    return bytes;
}

} // namespace prt
