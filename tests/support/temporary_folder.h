#pragma once

#include <filesystem>
#include <string_view>

namespace prt::test {

/// A separate folder for a test, removed at the end.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    /// Writes a file of `text` and returns its path.
    std::filesystem::path file(std::string_view name, std::string_view text) const;
    /// Number of files in the folder.
    std::size_t files() const;

private:
    std::filesystem::path path_;
};

/// A real file of the shared test data; empty where it is not there.
std::filesystem::path shared_file(std::string_view name);

} // namespace prt::test
