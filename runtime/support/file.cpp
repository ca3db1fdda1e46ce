// Files are written beside their place and renamed, so that none is ever half there.
#include "prt/support/file.h"

#include "prt/support/error.h"
#include "support/input_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

namespace prt {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
    try {
        return InputFile(path).read_all();
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

std::filesystem::path followed(std::filesystem::path path) {
    constexpr int kMostLinks = 40; // as Linux
    std::error_code error;
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
        const std::filesystem::path to = std::filesystem::read_symlink(path, error);
        if (error)
            break;
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)), target_(followed(path_)) {
    std::error_code error;
    const auto status = std::filesystem::status(target_, error);
    if (std::filesystem::is_directory(status))
        throw Error(path_.string() + ": is a folder and cannot be written as a file");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(path_.string() + ": is not a regular file and cannot be replaced");
    std::string name = target_.string() + ".XXXXXX";
    descriptor_ = ::mkstemp(name.data());
    temporary_ = name;
    if (descriptor_ < 0)
        fail("cannot be written");
    // mkstemp makes files private; an output has the usual permissions of the user.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor_, 0666 & ~mask);
}

OutputFile::~OutputFile() {
    if (descriptor_ < 0)
        return;
    ::close(descriptor_);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void OutputFile::fail(const char* what) const {
    throw Error(path_.string() + ": " + what + ": " + std::strerror(errno));
}

void OutputFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR)
            fail("cannot be written");
        if (written > 0)
            bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void OutputFile::commit() {
    if (::fsync(descriptor_) != 0 && errno != EINVAL)
        fail("cannot be written");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail("cannot be written");
    ::close(descriptor_);
    descriptor_ = -1;
}

} // namespace prt
