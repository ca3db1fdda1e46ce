// Writes files without a name, or under a hidden one, and names them when they are complete. No partial file
// remains, however the process ends.
#include "prt/core/error.h"
#include "runtime/core/support/file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace prt {
namespace {

using Path = std::filesystem::path;

constexpr mode_t kMode = 0666; // reduced by the user's umask

std::string descriptor_path(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

/// Returns whether `path` refers to an open descriptor, such as /dev/fd/1, rather than a name.
bool is_descriptor(const Path& path) {
    std::error_code error;
    const Path folder = std::filesystem::canonical(path.parent_path(), error);
    return !error && folder.filename() == "fd" && folder.string().starts_with("/proc/");
}

/// Returns the prefix of hidden names in the folder of `target`: short, and identical in every run
/// (Fowler-Noll-Vo hash).
std::string hidden_prefix(const Path& target) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : target.filename().string())
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    std::array<char, 32> text = {};
    std::snprintf(text.data(), text.size(), ".prtkit-%016llx-", static_cast<unsigned long long>(hash));
    return text.data();
}

Path hidden_name(const Path& target) {
    static std::atomic<unsigned> count = 0;
    return target.parent_path() /
           (hidden_prefix(target) + std::to_string(::getpid()) + "-" + std::to_string(++count));
}

/// Locks a file for its writer. The lock ends with the process in any case.
bool lock(int descriptor) {
    return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

struct CloseFolder {
    void operator()(DIR* folder) const { ::closedir(folder); }
};

/// Removes hidden files for `target` that no process is writing.
void remove_leftovers(const Path& target) {
    const std::string prefix = hidden_prefix(target);
    const Path folder = target.parent_path().empty() ? Path(".") : target.parent_path();
    // The iterator of the standard library terminates the program if it cannot allocate memory.
    const std::unique_ptr<DIR, CloseFolder> entries(::opendir(folder.c_str()));
    if (!entries)
        return;
    while (const dirent* entry = ::readdir(entries.get())) {
        if (!std::string_view(entry->d_name).starts_with(prefix))
            continue;
        const Path path = folder / entry->d_name;
        const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (descriptor < 0)
            continue;
        if (lock(descriptor))
            ::unlink(path.c_str());
        ::close(descriptor);
    }
}

/// Opens a file without a name in the folder of `target`; returns a negative value if this is not supported.
int open_unnamed(const Path& target) {
#ifdef O_TMPFILE
    const Path folder = target.parent_path();
    const int descriptor =
        ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
    if (descriptor >= 0 && ::access(descriptor_path(descriptor).c_str(), F_OK) == 0)
        return descriptor;
    if (descriptor >= 0)
        ::close(descriptor);
#endif
    return -1;
}

/// Creates and locks a file with a unique hidden name in the folder of `target`; returns a negative value on
/// failure.
int open_hidden(const Path& target, Path& name) {
    constexpr int kMaxTries = 100;
    for (int i = 0; i < kMaxTries; ++i) {
        name = hidden_name(target);
        const int descriptor = ::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode);
        if (descriptor < 0 && errno != EEXIST)
            return -1;
        struct stat status = {};
        // Another process may have removed it as a leftover before it was locked.
        if (descriptor >= 0 && lock(descriptor) && ::fstat(descriptor, &status) == 0 && status.st_nlink > 0)
            return descriptor;
        if (descriptor >= 0)
            ::close(descriptor);
    }
    return -1;
}

bool rename_with(const Path& from, const Path& to, unsigned flags) {
#ifdef RENAME_EXCHANGE
    return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0;
#else
    return false;
#endif
}

/// Writes all bytes. Returns 0 or the error.
int write_all(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR)
            return errno;
        if (written > 0)
            bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

} // namespace

Path followed(Path path) {
    constexpr int kMaxLinks = 40; // the limit of Linux
    std::error_code error;
    for (int i = 0; i < kMaxLinks && !is_descriptor(path) && std::filesystem::is_symlink(path, error); ++i) {
        const Path to = std::filesystem::read_symlink(path, error);
        if (error)
            break;
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}

OutputFile::OutputFile(Path path) : path_(std::move(path)), target_(followed(path_)) {
    std::error_code error;
    const auto status = std::filesystem::status(target_, error);
    if (std::filesystem::is_directory(status))
        throw Error(path_.string() + ": is a folder; the output must be a file");
    if (status.type() == std::filesystem::file_type::none)
        fail(error.value()); // for example, a name that is too long
    stream_ = is_descriptor(target_) ||
              (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status));
    open();
}

void OutputFile::open() {
    if (stream_) {
        if (::access(target_.c_str(), W_OK) != 0)
            fail(errno);
        descriptor_ = ::memfd_create("prtkit", MFD_CLOEXEC);
    } else {
        remove_leftovers(target_);
        descriptor_ = open_unnamed(target_);
        if (descriptor_ < 0)
            descriptor_ = open_hidden(target_, beside_);
    }
    if (descriptor_ < 0)
        fail(errno);
    if (!beside_.empty())
        return;
    lock(descriptor_);
    unnamed_ = descriptor_path(descriptor_);
}

OutputFile::~OutputFile() {
    if (descriptor_ < 0)
        return;
    if (stage_ == Stage::created)
        ::unlink(target_.c_str());
    if (stage_ == Stage::replaced && !beside_.empty())
        ::rename(beside_.c_str(), target_.c_str());
    remove_name();
    ::close(descriptor_);
}

void OutputFile::remove_name() const noexcept {
    if (stage_ == Stage::written && !beside_.empty())
        ::unlink(beside_.c_str());
}

void OutputFile::fail(int error) const {
    throw Error(path_.string() + ": cannot be written: " + std::strerror(error));
}

void OutputFile::write(std::span<const std::byte> bytes) {
    if (const int error = write_all(descriptor_, bytes))
        fail(error);
}

std::uintmax_t OutputFile::size() const {
    struct stat status = {};
    if (::fstat(descriptor_, &status) != 0)
        fail(errno);
    return static_cast<std::uintmax_t>(status.st_size);
}

void OutputFile::finish() {
    if (!stream_ && ::fsync(descriptor_) != 0 && errno != EINVAL)
        fail(errno);
}

/// Copies the written data to a stream.
void OutputFile::pour() {
    // O_APPEND: if a shell redirected the stream to a file, the data follows earlier output.
    const int stream = ::open(target_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (stream < 0)
        fail(errno);
    std::array<std::byte, 65536> block;
    int error = 0;
    ssize_t read = 0;
    for (off_t at = 0; error == 0; at += read) {
        read = ::pread(descriptor_, block.data(), block.size(), at);
        if (read <= 0)
            break;
        error = write_all(stream, std::span(block).first(static_cast<std::size_t>(read)));
    }
    if (read < 0)
        error = errno;
    if (::close(stream) != 0 && error == 0)
        error = errno;
    if (error != 0)
        fail(error);
}

/// Links a file without a name to a hidden name.
void OutputFile::link_beside() {
    Path name = hidden_name(target_);
    if (::linkat(AT_FDCWD, unnamed_.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0)
        fail(errno);
    beside_ = std::move(name);
}

void OutputFile::publish() {
    if (stream_) {
        pour();
        stage_ = Stage::kept;
        return;
    }
    if (beside_.empty()) {
        if (::linkat(AT_FDCWD, unnamed_.c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0) {
            stage_ = Stage::created;
            return;
        }
        link_beside(); // an old file exists; it can be replaced only by a named file
    }
    if (rename_with(beside_, target_, RENAME_NOREPLACE)) {
        stage_ = Stage::created;
    } else if (rename_with(beside_, target_, RENAME_EXCHANGE)) {
        stage_ = Stage::replaced;
    } else if (::rename(beside_.c_str(), target_.c_str()) == 0) {
        stage_ = Stage::replaced; // permanently: this system cannot exchange files
        beside_.clear();
    } else {
        fail(errno);
    }
}

void OutputFile::keep() noexcept {
    if (stage_ == Stage::replaced && !beside_.empty())
        ::unlink(beside_.c_str());
    stage_ = Stage::kept;
}

void OutputFile::commit() {
    finish();
    publish();
    keep();
}

} // namespace prt
