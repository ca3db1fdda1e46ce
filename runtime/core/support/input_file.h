#pragma once

// Input from files and pipes.

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt {

/// A regular file or a pipe, open for reading. Other kinds of files (folders, endless devices) are rejected.
/// Throws `Error` without the file name.
class InputFile {
public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// Reads all data, up to 4 GB from a file and 1 GB from a pipe.
    std::vector<std::byte> read_all();

private:
    std::size_t read_some(std::byte* to, std::size_t size);
    int descriptor_;
    bool pipe_ = false;
    bool begun_ = false;   ///< a process writes, or has written, to the pipe
    std::size_t size_ = 0; ///< size of a regular file when it was opened
};

} // namespace prt
