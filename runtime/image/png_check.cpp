#include "png_check.h"

#include "image_kind.h"
#include "image_limits.h"
#include "prt/support/error.h"

#include <stb/stb_image.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <cstring>
#include <vector>

namespace prt {
namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    return std::to_integer<std::uint32_t>(bytes[0]) << 24 | std::to_integer<std::uint32_t>(bytes[1]) << 16 |
           std::to_integer<std::uint32_t>(bytes[2]) << 8 | std::to_integer<std::uint32_t>(bytes[3]);
}

/// The contents of all IDAT chunks: pixels, deflated (PNG, third edition, sections 5.3 and 11.2.3).
std::vector<std::byte> deflated_pixels(std::span<const std::byte> file) {
    constexpr std::size_t kLengthAndType = 8, kChecksum = 4;
    std::vector<std::byte> pixels;
    auto rest = file.subspan(kPngMagic.size());
    while (rest.size() >= kLengthAndType) {
        const std::size_t length = big_endian(rest);
        const bool holds_pixels = std::memcmp(&rest[4], "IDAT", 4) == 0;
        if (std::memcmp(&rest[4], "IEND", 4) == 0)
            break;
        rest = rest.subspan(kLengthAndType);
        if (length > rest.size())
            throw Error("is a damaged PNG: a chunk reaches beyond its end");
        if (holds_pixels)
            pixels.insert(pixels.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(length));
        rest = rest.subspan(std::min(length + kChecksum, rest.size()));
    }
    return pixels;
}

} // namespace

void check_png(std::span<const std::byte> file, ImageSize size) {
    constexpr std::size_t kMostInflation = 1032; // of deflate
    const std::vector<std::byte> pixels = deflated_pixels(file);
    if (pixels.size() * kMostInflation < kFreeImageMemory)
        return;
    // Four channels at most; each row has a byte for its filter, interlaced ones have twice as many rows.
    const bool wide = stbi_is_16_bit_from_memory(reinterpret_cast<const stbi_uc*>(file.data()),
                                                 static_cast<int>(file.size())) != 0;
    const std::size_t pixel = wide ? 8 : 4;
    std::vector<char> raw(pixel * static_cast<std::size_t>(size.width) *
                              static_cast<std::size_t>(size.height) +
                          4 * static_cast<std::size_t>(size.height) + 16);
    if (stbi_zlib_decode_buffer(raw.data(), static_cast<int>(std::min<std::size_t>(raw.size(), INT_MAX)),
                                reinterpret_cast<const char*>(pixels.data()),
                                static_cast<int>(pixels.size())) < 0)
        throw Error("is a damaged PNG: its pixels cannot be inflated, or are more than its header says");
}

} // namespace prt
