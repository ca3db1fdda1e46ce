#pragma once

// Detection of image formats by their first bytes.

#include <algorithm>
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

/// Returns whether the file is an AVIF image or sequence: the first box lists "avif" or "avis" among its
/// brands (ISO/IEC 14496-12, section 4.3), not necessarily as the first.
inline bool is_avif(std::span<const std::byte> file) {
    constexpr std::size_t kBrands = 8, kBrand = 4;
    if (file.size() < kBrands || !begins_with(file.subspan(4), "ftyp"))
        return false;
    std::size_t box = 0;
    for (std::size_t i = 0; i < 4; ++i)
        box = box << 8 | std::to_integer<std::size_t>(file[i]);
    for (std::size_t at = kBrands; at + kBrand <= std::min(box, file.size()); at += kBrand)
        if (begins_with(file.subspan(at), "avif") || begins_with(file.subspan(at), "avis"))
            return true;
    return false;
}

/// Returns whether the file is a Radiance HDR.
inline bool is_hdr(std::span<const std::byte> file) {
    return begins_with(file, "#?");
}

} // namespace prt
