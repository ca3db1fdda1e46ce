#pragma once

// Files that are written whole or not at all. Experimental.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace prt {

/// A whole file to 4 GB, or a pipe to 1 GB. Throws `Error` that names it for all else, and if it is empty.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// The path that writing to `path` ends at: symbolic links are followed, also one whose end is not there yet.
/// One to an open descriptor, as /dev/stdout is, stays: behind it there is no name to write to.
std::filesystem::path followed(std::filesystem::path path);

/// A file that appears under its name only when it is complete. Until then it has no name where the system
/// can do so, and a hidden one beside its place elsewhere, which the next who writes there removes if the
/// process was killed. A link is followed, not replaced. What is no regular file (a pipe, /dev/null,
/// /dev/stdout) gets the bytes when it is published.
class OutputFile {
public:
    /// Throws `Error` when nothing can be written there: no such folder, no permission, a folder.
    explicit OutputFile(std::filesystem::path path);
    /// Without `keep` it leaves nothing, and the old file as it was.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// As it was named.
    const std::filesystem::path& path() const { return path_; }
    /// Whether what is written cannot be taken back: a pipe, a device, an open descriptor.
    bool is_stream() const { return stream_; }
    /// Appends. Throws `Error` when the disk is full.
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
    /// Bytes written so far.
    std::uintmax_t size() const;

    /// Flushes to disk. Throws `Error` when that fails.
    void finish();
    /// Gives the file its name; what had it is still there, and comes back unless `keep` follows.
    void publish();
    void keep() noexcept;
    /// All three.
    void commit();
    /// Removes what of an unpublished file has a name; for a process that is about to end.
    void remove_name() const noexcept;

private:
    enum class Stage { written, created, replaced, kept };
    [[noreturn]] void fail(int error) const;
    void open();
    void link_beside();
    void pour();
    std::filesystem::path path_, target_; ///< as named; where links lead
    std::filesystem::path unnamed_;       ///< how to open it where it has no name
    std::filesystem::path beside_;        ///< its hidden name, or that of the old file; may be empty
    int descriptor_ = -1;
    bool stream_ = false;
    Stage stage_ = Stage::written;
};

} // namespace prt
