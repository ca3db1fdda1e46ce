#pragma once

// Reading of whole files, and output files that are written completely or not at all. Experimental.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace prt {

/// Returns the bytes of a whole file of at most 4 GB, or of a pipe of at most 1 GB (1 GB = 2^30 bytes).
/// Throws `Error` with the path if the file is larger, is empty, cannot be read, or is neither a regular file
/// nor a pipe, and if no process opens the other end of a pipe within about 3 seconds. Waits without a limit
/// for the data of a process that has opened it.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// Returns the path of the file that a write to `path` changes: follows symbolic links, even if the last
/// target does not exist yet. Returns `path` unchanged if it is not a link. Stops at the path of an open
/// descriptor, such as /proc/self/fd/1 to which /dev/stdout links, at a link that cannot be read, and after
/// 40 links. Throws no `Error`.
std::filesystem::path followed(std::filesystem::path path);

/// An output file that appears under its path only when it is complete: call `write`, then `commit`; or
/// `finish`, `publish` and `keep` separately, to publish several files together. Until `publish` the data is
/// in a file without a name, or, if the system does not support that, in a hidden file in the same folder; if
/// the process is killed, the next `OutputFile` for the same path removes the hidden file. A symbolic link is
/// followed, not replaced. A target that is an open descriptor (/dev/stdout), or that exists and is not a
/// regular file (a pipe, /dev/null), is a stream: the data is in memory until `publish` writes all bytes to
/// the target, after earlier output.
class OutputFile {
public:
    /// Prepares to write to `path`; does not change an existing file. Throws `Error` if `path` cannot be
    /// written, for example because its folder is missing, permission is missing, or `path` is a folder. A
    /// regular file needs permission to write to its folder, not to an existing file, which is replaced.
    explicit OutputFile(std::filesystem::path path);
    /// If `keep` was not called: removes the new file, and restores the file that `publish` replaced. If
    /// `publish` replaced that file permanently, the new file remains. Bytes that `publish` wrote to a stream
    /// remain written.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// The path as passed to the constructor, before links are followed.
    const std::filesystem::path& path() const { return path_; }
    /// Returns whether the target is an open descriptor, or exists and is not a regular file (a pipe, a
    /// device). Data that `publish` writes to a stream cannot be withdrawn.
    bool is_stream() const { return stream_; }
    /// Appends `bytes`. Throws `Error` if the write fails, for example because the disk is full. Must not be
    /// called after `publish`.
    void write(std::span<const std::byte> bytes);
    /// Appends the characters of `text` as bytes. Throws `Error` if the write fails, for example because the
    /// disk is full. Must not be called after `publish`.
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
    /// Returns the number of bytes that all calls of `write` have appended. Throws `Error` if the system does
    /// not report it.
    std::uintmax_t size() const;

    /// Flushes the written data to disk; does nothing if `is_stream()`. Throws `Error` on failure. Call it
    /// after the last `write` and before `publish`; without it, a power failure can leave an incomplete file.
    void finish();
    /// Publishes the file under its path; writes all bytes to the target if `is_stream()`. A previous file
    /// with this path is kept under a hidden name; the destructor restores the previous file unless `keep` is
    /// called. If the file system cannot exchange two files, the previous file is replaced permanently.
    /// Throws `Error` on failure; a stream may then have received some of the bytes.
    void publish();
    /// Makes the published file permanent: removes the previous file, if `publish` kept one under a hidden
    /// name. Must be called after `publish`.
    void keep() noexcept;
    /// Calls `finish`, `publish` and `keep`. Throws `Error` on failure.
    void commit();
    /// Deletes the hidden file of unpublished data, if there is one; its data can then not be published. For
    /// a process that is interrupted and runs no destructors.
    void remove_name() const noexcept;

private:
    enum class Stage {
        written,  ///< before `publish`
        created,  ///< published; no previous file existed
        replaced, ///< published; a previous file was replaced
        kept      ///< permanent, or written to a stream
    };
    [[noreturn]] void fail(int error) const;
    void open();
    void link_beside();
    void pour();
    std::filesystem::path path_, target_; ///< path as passed in; path after following links
    /// /proc/self/fd/N of the file that receives the bytes; empty if the constructor gave it a hidden name.
    std::filesystem::path unnamed_;
    /// Stage::written: hidden name of the new file, or empty. Stage::replaced: hidden name of the previous
    /// file; empty if it cannot be restored. Not used in other stages.
    std::filesystem::path beside_;
    int descriptor_ = -1;
    bool stream_ = false;
    Stage stage_ = Stage::written;
};

} // namespace prt
