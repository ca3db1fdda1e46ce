#pragma once

// What files of images begin with.

#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

namespace prt {

inline bool begins_with(std::span<const std::byte> file, std::string_view magic) {
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

inline constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";

inline bool is_png(std::span<const std::byte> file) {
    return begins_with(file, kPngMagic);
}

inline bool is_jpeg(std::span<const std::byte> file) {
    return begins_with(file, "\xff\xd8\xff");
}

inline bool is_webp(std::span<const std::byte> file) {
    return begins_with(file, "RIFF") && file.size() >= 12 && begins_with(file.subspan(8), "WEBP");
}

/// Still or a sequence.
inline bool is_avif(std::span<const std::byte> file) {
    return file.size() >= 12 &&
           (begins_with(file.subspan(4), "ftypavif") || begins_with(file.subspan(4), "ftypavis"));
}

/// Radiance HDR.
inline bool is_hdr(std::span<const std::byte> file) {
    return begins_with(file, "#?");
}

} // namespace prt
