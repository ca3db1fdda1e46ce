#pragma once

// Common code of the fuzz targets. A target ends in one of two ways: it rejects the input with an `Error`, or
// its result is valid. Everything else is a finding: `expect` and any other exception end the process.

#include "prt/core/error.h"

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

/// An invalid result. No target catches it: it ends the process, and libFuzzer reports the input.
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

/// Returns the part of a message before it quotes the file, in quotation marks or as a URI; libFuzzer fills
/// the quotation with the words below and with quotes.
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

/// Calls `work`, which may reject the input.
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
