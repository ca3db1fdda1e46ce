// Reads PNG, JPEG and Radiance HDR by stb. stb is compiled here with zeroed allocations: where it returns
// memory that it never wrote, for example for a JPEG without a scan, the memory is zero.
#include "runtime/image/stb_images.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/image/image_kind.h"
#include "runtime/image/image_limits.h"
#include "runtime/image/png_check.h"
#include "runtime/image/radiance_header.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace {

void* zeroed_malloc(std::size_t size) {
    return std::calloc(1, size);
}

void* zeroed_realloc(void* old, std::size_t old_size, std::size_t size) {
    auto* bytes = static_cast<char*>(std::realloc(old, size));
    if (bytes && size > old_size)
        std::memset(bytes + old_size, 0, size - old_size);
    return bytes;
}

} // namespace

#define STBI_MALLOC zeroed_malloc
#define STBI_REALLOC_SIZED zeroed_realloc
#define STBI_REALLOC(old, size) zeroed_realloc(old, size, size)
#define STBI_FREE std::free
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STB_IMAGE_STATIC // avoids conflicts with the copy of a game
#define STB_IMAGE_IMPLEMENTATION
#if defined(__clang__) // integers wrap around in damaged JPEGs
#pragma clang attribute push(__attribute__((no_sanitize("undefined"))), apply_to = function)
#endif
#include <stb/stb_image.h>
#if defined(__clang__)
#pragma clang attribute pop
#endif

namespace prt {
namespace {

struct StbFree {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

const stbi_uc* stb_bytes(std::span<const std::byte> file) {
    return reinterpret_cast<const stbi_uc*>(file.data());
}

int stb_size(std::span<const std::byte> file) {
    if (file.size() > INT_MAX)
        throw Error("is larger than 2 GB");
    return static_cast<int>(file.size());
}

/// Passes a file in memory to stb piece by piece, and detects reads beyond the end. stb would silently use
/// zeros for missing data, and loop forever over runs of length zero. Missing data is therefore replaced by
/// bytes that end runs.
struct ByteStream {
    std::span<const std::byte> rest;
    bool past_end = false;

    static int read(void* user, char* to, int size) {
        auto& stream = *static_cast<ByteStream*>(user);
        const std::size_t count = std::min(static_cast<std::size_t>(size), stream.rest.size());
        if (count == 0) {
            stream.past_end = true;
            std::memset(to, 0xff, static_cast<std::size_t>(size));
            return size;
        }
        std::memcpy(to, stream.rest.data(), count);
        stream.rest = stream.rest.subspan(count);
        return static_cast<int>(count);
    }
    static void skip(void* user, int count) {
        auto& stream = *static_cast<ByteStream*>(user);
        stream.rest =
            stream.rest.subspan(std::min(static_cast<std::size_t>(std::max(count, 0)), stream.rest.size()));
    }
    static int eof(void* user) { return static_cast<ByteStream*>(user)->rest.empty(); }
};

/// Returns the peak memory of stb and `decode_by_stb` per pixel. JPEG: samples, coefficients of three
/// channels, and pixels. PNG: inflated bytes and pixels, then both kinds of pixels.
std::size_t bytes_per_pixel(std::span<const std::byte> file) {
    if (is_jpeg(file))
        return 13;
    return png_bit_depth(file) == 16 ? 16 : 8;
}

/// Throws `Error` if a JPEG ends before its first scan, which stb accepts.
void check_jpeg(std::span<const std::byte> file) {
    constexpr std::byte kMark{0xff}, kStartOfScan{0xda};
    const auto number = [&](std::size_t at) { return std::to_integer<std::size_t>(file[at]); };
    for (std::size_t at = 2; at + 4 <= file.size();) { // after the start-of-image marker
        if (file[at] != kMark || file[at + 1] == kMark)
            ++at; // padding
        else if (file[at + 1] == kStartOfScan)
            return;
        else
            at += 2 + (number(at + 2) << 8) + number(at + 3);
    }
    throw Error("is a damaged JPEG: it has no pixels");
}

} // namespace

RadianceImage decode_hdr(std::span<const std::byte> file) {
    const RadianceHeader header = read_radiance_header(file);
    const ImageSize size = header.size;
    check_image_size(size.width, size.height, 2 * sizeof(glm::vec3), file.size()); // memory of stb and of the
                                                                                   // result
    // stb reads lines only from left to right and downwards: the header is rewritten to that orientation.
    std::string plain = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(header.lines()) +
                        " +X " + std::to_string(header.line_length()) + "\n";
    const std::span<const std::byte> pixel_bytes = file.subspan(header.bytes);
    plain.append(reinterpret_cast<const char*>(pixel_bytes.data()), pixel_bytes.size());
    int line_length = 0, lines = 0, channels = 0;
    const stbi_io_callbacks callbacks{ByteStream::read, ByteStream::skip, ByteStream::eof};
    ByteStream stream{std::as_bytes(std::span(plain))};
    const std::unique_ptr<float, StbFree> pixels(
        stbi_loadf_from_callbacks(&callbacks, &stream, &line_length, &lines, &channels, 3));
    if (stream.past_end)
        throw Error("is a damaged Radiance HDR: it ends before its last pixel");
    if (!pixels)
        throw Error(std::string("is a damaged or unsupported Radiance HDR: ") +
                    printable(stbi_failure_reason()));
    RadianceImage result{{size.width, size.height, {}}, header.factor};
    result.image.pixels.resize(header.lines() * header.line_length());
    // The inverse of the matrix from Rec. 709 to XYZ (ITU-R BT.709, white D65), by columns.
    const glm::dmat3 to_rgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                            0.0415560, 1.0572252);
    const glm::dvec3 scale = 1.0 / header.factor;
    const float* from = pixels.get();
    for (std::size_t line = 0; line < header.lines(); ++line)
        for (std::size_t i = 0; i < header.line_length(); ++i, from += 3) {
            const glm::dvec3 pixel = scale * glm::dvec3(from[0], from[1], from[2]);
            result.image.pixels[header.index(line, i)] = glm::vec3(header.xyz ? to_rgb * pixel : pixel);
        }
    return result;
}

ImageSize size_by_stb(std::span<const std::byte> file) {
    if (!is_png(file) && !is_jpeg(file) && !is_hdr(file)) // stb reads more formats, with less validation
        throw Error("is not an image in a supported format (PNG, JPEG, WebP, AVIF)");
    if (is_hdr(file))
        return read_radiance_header(file).size;
    if (is_png(file))
        check_png_chunks(file);
    ImageSize size;
    int channels = 0;
    if (!stbi_info_from_memory(stb_bytes(file), stb_size(file), &size.width, &size.height, &channels))
        throw Error(std::string("is a damaged or unsupported image: ") + printable(stbi_failure_reason()));
    return size;
}

Image8 decode_by_stb(std::span<const std::byte> file) {
    if (is_hdr(file))
        throw Error("is a Radiance HDR, not a PNG or JPEG");
    const ImageSize size = size_by_stb(file);
    check_image_size(size.width, size.height, bytes_per_pixel(file), file.size());
    std::vector<std::byte> whole;
    if (is_png(file)) {
        check_png(file, size);
        whole = with_whole_palette(file);
        if (!whole.empty())
            file = whole;
    } else {
        check_jpeg(file);
    }
    Image8 image;
    int channels = 0;
    const std::unique_ptr<stbi_uc, StbFree> pixels(
        stbi_load_from_memory(stb_bytes(file), stb_size(file), &image.width, &image.height, &channels, 4));
    if (!pixels)
        throw Error(std::string("is a damaged or unsupported image: ") + printable(stbi_failure_reason()));
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * sizeof(glm::u8vec4));
    return image;
}

} // namespace prt
