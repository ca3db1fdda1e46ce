#pragma once

// Files that are written whole or not at all. Experimental.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace prt {

/// A whole file to 4 GB, or a pipe to 1 GB. Throws `Error` that names it for all else, and if it is empty.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// The path that writing to `path` ends at: symbolic links are followed, also one whose end is not there yet.
std::filesystem::path followed(std::filesystem::path path);

/// A file that appears under its name only when it is complete: it is written beside and renamed by `commit`.
/// A link is followed, not replaced. Destroyed without `commit`, it leaves nothing and the old file as it
/// was.
class OutputFile {
public:
    /// Throws `Error` when nothing can be written there: no such folder, no permission, not a regular file.
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Where to write, for libraries that open files themselves.
    const std::filesystem::path& temporary_path() const { return temporary_; }
    /// Appends. Throws `Error` when the disk is full.
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
    /// Flushes to disk and renames. Throws `Error` when that fails.
    void commit();

private:
    [[noreturn]] void fail(const char* what) const;
    std::filesystem::path path_, target_, temporary_; ///< as named; where links lead; beside it
    int descriptor_ = -1;
};

} // namespace prt
