// Creates and removes temporary folders.

#include "temporary_folder.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace prt::test {

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "prt-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::file(std::string_view name, std::string_view text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
}

std::size_t TemporaryFolder::files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
}

std::filesystem::path shared_file(std::string_view name) {
    const std::filesystem::path path = std::filesystem::path(PRT_TEST_DATA) / name;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

} // namespace prt::test
