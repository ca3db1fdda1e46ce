#include "png_check.h"

#include "image_kind.h"
#include "image_limits.h"
#include "prt/support/error.h"
#include "prt/support/printable.h"

#include <stb/stb_image.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace prt {
namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    return std::to_integer<std::uint32_t>(bytes[0]) << 24 | std::to_integer<std::uint32_t>(bytes[1]) << 16 |
           std::to_integer<std::uint32_t>(bytes[2]) << 8 | std::to_integer<std::uint32_t>(bytes[3]);
}

struct Chunk {
    std::string_view type; ///< four bytes
    std::size_t length = 0;
    std::span<const std::byte> data; ///< shorter where the file ends
};

/// Takes the next chunk from `rest` (PNG, third edition, section 5.3); none at the end.
std::optional<Chunk> next_chunk(std::span<const std::byte>& rest) {
    constexpr std::size_t kLengthAndType = 8, kChecksum = 4;
    if (rest.size() < kLengthAndType)
        return std::nullopt;
    Chunk chunk{{reinterpret_cast<const char*>(&rest[4]), 4}, big_endian(rest), {}};
    if (chunk.type == "IEND")
        return std::nullopt;
    rest = rest.subspan(kLengthAndType);
    chunk.data = rest.first(std::min(chunk.length, rest.size()));
    rest = rest.subspan(std::min(chunk.length + kChecksum, rest.size()));
    return chunk;
}

/// The contents of all IDAT chunks: pixels, deflated (section 11.2.3).
std::vector<std::byte> deflated_pixels(std::span<const std::byte> file) {
    std::vector<std::byte> pixels;
    auto rest = file.subspan(kPngMagic.size());
    while (const auto chunk = next_chunk(rest)) {
        if (chunk->length > chunk->data.size())
            throw Error("is a damaged PNG: a chunk reaches beyond its end");
        if (chunk->type == "IDAT")
            pixels.insert(pixels.end(), chunk->data.begin(), chunk->data.end());
    }
    return pixels;
}

} // namespace

void check_png_chunks(std::span<const std::byte> file) {
    auto rest = file.subspan(kPngMagic.size());
    while (const auto chunk = next_chunk(rest)) {
        const bool critical = (chunk->type[0] & 0x20) == 0; // section 5.4
        if (critical && chunk->type != "IHDR" && chunk->type != "PLTE" && chunk->type != "IDAT")
            throw Error("is a damaged PNG: it has a critical chunk '" + printable(chunk->type) + "'");
    }
}

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
