// Validates PNG files before stb decodes them.
#include "runtime/image/png_check.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/image/image_kind.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <optional>
#include <string_view>

namespace prt {
namespace {

constexpr std::size_t kLengthAndType = 8, kChecksum = 4;

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    return std::to_integer<std::uint32_t>(bytes[0]) << 24 | std::to_integer<std::uint32_t>(bytes[1]) << 16 |
           std::to_integer<std::uint32_t>(bytes[2]) << 8 | std::to_integer<std::uint32_t>(bytes[3]);
}

struct Chunk {
    std::string_view type; ///< four bytes
    std::size_t length = 0;
    std::span<const std::byte> data; ///< truncated at the end of the file
};

/// Removes the next chunk from `rest` (PNG, third edition, section 5.3); empty at the end.
std::optional<Chunk> next_chunk(std::span<const std::byte>& rest) {
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

/// Counts the inflated size of data without storing it.
class Inflation {
public:
    Inflation() {
        constexpr int kNoHeader = -15; // maximum window and no checksum: stb checks neither
        if (inflateInit2(&stream_, kNoHeader) != Z_OK)
            throw std::bad_alloc();
    }
    ~Inflation() { inflateEnd(&stream_); }
    Inflation(const Inflation&) = delete;

    void add(std::span<const std::byte> deflated, std::uint64_t most) {
        // zlib does not write to its input, but its type is const only on request.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(deflated.data()));
        stream_.avail_in = static_cast<uInt>(deflated.size());
        while (!ended_ && (stream_.avail_in > 0 || stream_.avail_out == 0)) {
            stream_.next_out = buffer_.data();
            stream_.avail_out = static_cast<uInt>(buffer_.size());
            const int result = inflate(&stream_, Z_NO_FLUSH);
            bytes_ += buffer_.size() - stream_.avail_out;
            ended_ = result == Z_STREAM_END;
            if (bytes_ > most || (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR))
                throw Error("is a damaged PNG: its pixels cannot be decompressed, or there are more than its "
                            "header declares");
            if (result == Z_BUF_ERROR)
                break; // needs more input
        }
    }

private:
    z_stream stream_ = {};
    std::array<Bytef, 1 << 15> buffer_;
    std::uint64_t bytes_ = 0;
    bool ended_ = false;
};

constexpr std::size_t kColor = 3; // bytes per palette color
constexpr std::size_t kPalette = 256 * kColor;

} // namespace

int png_bit_depth(std::span<const std::byte> file) {
    constexpr std::size_t kDepth = kPngMagic.size() + kLengthAndType + 8; // after width and height
    return file.size() > kDepth ? std::to_integer<int>(file[kDepth]) : 0;
}

bool is_png_of_bytes(std::span<const std::byte> file) {
    constexpr std::size_t kColorType = kPngMagic.size() + kLengthAndType + 9; // after the bit depth
    constexpr std::byte kRgba{6};
    return is_png(file) && png_bit_depth(file) == 8 && file.size() > kColorType && file[kColorType] == kRgba;
}

void check_png_chunks(std::span<const std::byte> file) {
    auto rest = file.subspan(kPngMagic.size());
    while (const auto chunk = next_chunk(rest)) {
        const bool critical = (chunk->type[0] & 0x20) == 0; // section 5.4
        if (critical && chunk->type != "IHDR" && chunk->type != "PLTE" && chunk->type != "IDAT")
            throw Error("is a damaged PNG: it has an unknown critical chunk '" + printable(chunk->type) +
                        "'");
    }
}

void check_png(std::span<const std::byte> file, ImageSize size) {
    // At most four channels; each row has a filter byte; interlaced images have up to twice the number of
    // rows.
    const std::uint64_t pixel = png_bit_depth(file) == 16 ? 8 : 4,
                        width = static_cast<std::uint64_t>(size.width),
                        height = static_cast<std::uint64_t>(size.height);
    const std::uint64_t most = pixel * width * height + 4 * height + 16;
    Inflation inflation;
    std::size_t header = 2; // zlib header, skipped
    auto rest = file.subspan(kPngMagic.size());
    while (const auto chunk = next_chunk(rest)) {
        if (chunk->length > chunk->data.size())
            throw Error("is a damaged PNG: a chunk reaches beyond the end of the file");
        if (chunk->type != "IDAT")
            continue;
        const std::size_t left_out = std::min(header, chunk->data.size());
        header -= left_out;
        inflation.add(chunk->data.subspan(left_out), most);
    }
}

std::vector<std::byte> with_whole_palette(std::span<const std::byte> file) {
    auto rest = file.subspan(kPngMagic.size());
    while (const auto chunk = next_chunk(rest)) {
        if (chunk->type != "PLTE" || chunk->data.size() >= kPalette || chunk->data.size() % kColor != 0)
            continue;
        std::vector<std::byte> whole(file.data(), chunk->data.data());
        whole[whole.size() - 6] = std::byte{kPalette >> 8}; // bytes of the length; its other bytes are 0
        whole[whole.size() - 5] = std::byte{kPalette & 0xff};
        whole.insert(whole.end(), chunk->data.begin(), chunk->data.end());
        whole.resize(whole.size() + kPalette - chunk->data.size());
        whole.insert(whole.end(), chunk->data.data() + chunk->data.size(), file.data() + file.size());
        return whole;
    }
    return {};
}

} // namespace prt
