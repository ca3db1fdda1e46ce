#pragma once

// What the fuzz targets share. A target ends in one of two ways: the input is refused with an `Error`, or
// what was made of it is whole. All else is a finding: `expect` and any other exception end the process.

#include "prt/support/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace prt::fuzz {

/// What should not be. No target catches it: it ends the process, which libFuzzer reports with the input.
struct Finding : std::logic_error {
    using std::logic_error::logic_error;
};

inline void expect(bool holds, const char* what) {
    if (!holds)
        throw Finding(what);
}

template <class Number>
void expect_finite(std::span<const Number> values, const char* what) {
    for (const Number value : values)
        expect(std::isfinite(value), what);
}

/// What a message says before it quotes the file, which libFuzzer fills with the words below and with quotes:
/// in quotation marks, or as a URI.
inline std::string_view before_quotes(std::string_view message) {
    return message.substr(0, std::min(message.find_first_of("\"'"), message.find("data:")));
}

/// A message is one line in our words: no name of a library's inner part.
inline void expect_plain(std::string_view message) {
    const std::string_view own = before_quotes(message);
    expect(!message.empty() && message.find('\n') == std::string_view::npos, "a message is not one line");
    for (const char* inner : {"std::bad_alloc", "std::length_error", "std::vector larger than", "vector::_M_",
                              "basic_string::", "[json.exception"})
        if (own.find(inner) != std::string_view::npos) {
            std::fprintf(stderr, "fuzz: message: %.*s\n", static_cast<int>(message.size()), message.data());
            expect(false, "a message shows what a library calls its inner parts");
        }
}

/// Calls `work`, which may refuse what came in.
template <class Work>
int take(Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        expect_plain(error.what());
    }
    return 0;
}

inline std::span<const std::byte> bytes(const std::uint8_t* data, std::size_t size) {
    return std::as_bytes(std::span(data, size));
}

} // namespace prt::fuzz
