// Reads regular files and pipes with limits on time and size.
#include "runtime/core/support/input_file.h"

#include "prt/core/error.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace prt {
namespace {

constexpr std::size_t kGigabyte = std::size_t{1} << 30, kBlock = std::size_t{1} << 20;
constexpr std::chrono::milliseconds kPatience(3000), kPause(10);

} // namespace

InputFile::InputFile(const std::filesystem::path& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) { // O_NONBLOCK: otherwise opening
                                                                             // a pipe waits for a writer
    if (descriptor_ < 0)
        throw Error(std::strerror(errno));
    struct stat status = {};
    const bool known = ::fstat(descriptor_, &status) == 0;
    pipe_ = known && S_ISFIFO(status.st_mode);
    if (known && (pipe_ || S_ISREG(status.st_mode))) {
        size_ = static_cast<std::size_t>(status.st_size);
        return;
    }
    ::close(descriptor_);
    throw Error(known && S_ISDIR(status.st_mode) ? "is a folder" : "is not a regular file or a pipe");
}

InputFile::~InputFile() {
    ::close(descriptor_);
}

/// Returns 0 at the end. A pipe without a writer reads as if it had ended; it gets a short grace period.
std::size_t InputFile::read_some(std::byte* to, std::size_t size) {
    for (auto waited = kPause;; waited += kPause) {
        const ssize_t count = ::read(descriptor_, to, size);
        if (count > 0 || (count == 0 && (!pipe_ || begun_))) {
            begun_ = true;
            return static_cast<std::size_t>(count);
        }
        if (count == 0 && waited > kPatience)
            throw Error("no data arrives from this pipe");
        if (count < 0 && errno == EAGAIN) {
            begun_ = true;
            pollfd wait{descriptor_, POLLIN, 0};
            ::poll(&wait, 1, -1);
        } else if (count < 0 && errno != EINTR) {
            throw Error(std::string("cannot be read: ") + std::strerror(errno));
        } else {
            std::this_thread::sleep_for(kPause);
        }
    }
}

std::vector<std::byte> InputFile::read_all() {
    const std::size_t most = (pipe_ ? 1 : 4) * kGigabyte;
    const auto check = [&](std::size_t size) {
        if (size > most)
            throw Error(pipe_ ? "is a pipe with more than 1 GB of data" : "is larger than 4 GB");
    };
    check(size_);
    std::vector<std::byte> bytes;
    bytes.reserve(size_ + kBlock);
    for (std::size_t read = 0;;) {
        bytes.resize(read + kBlock);
        const std::size_t count = read_some(&bytes[read], kBlock);
        read += count;
        check(read);
        if (count > 0)
            continue;
        bytes.resize(read);
        break;
    }
    if (bytes.empty())
        throw Error("the file is empty");
    return bytes;
}

} // namespace prt
