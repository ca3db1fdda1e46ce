#include "terminal.h"

#include "prt/support/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace prt::cli {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Controls, marks that turn the direction of writing, and line ends (Unicode 15, categories Cc, Cf, Zl, Zp).
bool acts_on_terminal(unsigned c) {
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x200e && c <= 0x200f) ||
           (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

/// Bytes of the printable character at the start of `text`, which is not empty; 0: there is none (RFC 3629).
std::size_t printable_length(std::string_view text) {
    const unsigned first = byte_at(text, 0);
    if (first < 0x80)
        return acts_on_terminal(first) ? 0 : 1;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length)
        return 0;
    unsigned point = first & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        const unsigned next = byte_at(text, i);
        if ((next & 0xc0) != 0x80)
            return 0;
        point = point << 6 | (next & 0x3f);
    }
    constexpr unsigned kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = point >= 0xd800 && point < 0xe000;
    return point < kLeast[length] || point > 0x10ffff || surrogate || acts_on_terminal(point) ? 0 : length;
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

std::string visible(std::string_view text) {
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string result;
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        if (length > 0)
            result += text.substr(0, length);
        else
            result.append("\\x")
                .append(1, kDigits[byte_at(text, 0) >> 4])
                .append(1, kDigits[byte_at(text, 0) & 15]);
        text.remove_prefix(length > 0 ? length : 1);
    }
    return result;
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
