#pragma once

// Files that are written completely or not at all. Experimental.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace prt {

/// Reads a whole file of up to 4 GB, or a pipe of up to 1 GB. Throws `Error` with the path if the file is
/// larger, empty or not readable.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// Returns the path that writing to `path` reaches: symbolic links are followed, also to a target that does
/// not exist yet. A link to an open descriptor, such as /dev/stdout, is kept, because there is no path behind
/// it.
std::filesystem::path followed(std::filesystem::path path);

/// A file that appears under its name only when it is complete. Until then it has no name, if the system
/// supports that. Otherwise it is a hidden file in the same folder; if the process is killed, the next writer
/// removes it. A link is followed, not replaced. A target that is not a regular file (a pipe, /dev/null,
/// /dev/stdout) gets the bytes on `publish`.
class OutputFile {
public:
    /// Throws `Error` if the path cannot be written: missing folder, no permission, or the path is a folder.
    explicit OutputFile(std::filesystem::path path);
    /// Without `keep`, removes the new file and leaves the old one unchanged.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// The path as passed to the constructor.
    const std::filesystem::path& path() const { return path_; }
    /// Returns whether written data cannot be withdrawn: a pipe, a device, an open descriptor.
    bool is_stream() const { return stream_; }
    /// Appends data. Throws `Error` if the disk is full.
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
    /// Number of bytes written.
    std::uintmax_t size() const;

    /// Flushes to disk. Throws `Error` on failure.
    void finish();
    /// Publishes the file under its name. A previous file with this name is set aside, and restored unless
    /// `keep()` follows.
    void publish();
    /// Accepts the published file and removes the old one.
    void keep() noexcept;
    /// Calls finish, publish and keep.
    void commit();
    /// Removes the hidden name of an unpublished file; for a process that is about to end.
    void remove_name() const noexcept;

private:
    enum class Stage { written, created, replaced, kept };
    [[noreturn]] void fail(int error) const;
    void open();
    void link_beside();
    void pour();
    std::filesystem::path path_, target_; ///< path as passed in; path after following links
    std::filesystem::path unnamed_;       ///< path to open the file while it has no name
    std::filesystem::path beside_;        ///< its hidden name, or that of the old file; may be empty
    int descriptor_ = -1;
    bool stream_ = false;
    Stage stage_ = Stage::written;
};

} // namespace prt
