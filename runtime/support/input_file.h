#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt {

/// A regular file or a pipe, open for reading; other kinds of files (folders, devices that never end) are
/// refused. Throws `Error` without the name.
class InputFile {
public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// All of it, up to 4 GB of a file and 1 GB of a pipe.
    std::vector<std::byte> read_all();

private:
    std::size_t read_some(std::byte* to, std::size_t size);
    int descriptor_;
    bool pipe_ = false;
    bool begun_ = false;   ///< somebody writes, or has written, to the pipe
    std::size_t size_ = 0; ///< of a regular file, when it was opened
};

} // namespace prt
