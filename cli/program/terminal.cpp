// Prints text without control sequences.

#include "cli/program/terminal.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>

#include <fcntl.h>
#include <unistd.h>

namespace prt::cli {
namespace {

/// All of `text`, on one line.
std::string visible(std::string_view text) {
    return printable(text, std::numeric_limits<std::size_t>::max());
}

void put(std::FILE* stream, const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stream);
    if (stream == stderr)
        std::fflush(stream);
}

} // namespace

void occupy_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            if (::open("/dev/null", O_RDONLY) < 0) // the lowest number is free; writing there fails
                return;
}

void print(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        put(stdout, visible(text.substr(0, end)) + (end == std::string_view::npos ? "" : "\n"));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
}

void flush_output() {
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        throw Error("standard output cannot be written" +
                    (errno != 0 ? std::string(": ") + std::strerror(errno) : std::string()));
}

void say(std::string_view what) {
    put(stderr, "prt: " + visible(what) + "\n");
}

void show(const std::string& text) {
    put(stderr, text);
}

} // namespace prt::cli
