// Writes PNG files by stb, compressed by zlib: the compressor of stb terminates the program if memory runs
// out.
#include "prt/image/image_file.h"

#include "prt/core/error.h"
#include "runtime/core/support/file.h"

#include <zlib.h>

#include <climits>
#include <cstdlib>
#include <memory>

namespace {

/// Compressor for stb: returns `size` bytes compressed into memory for free(), or null if there is no memory.
unsigned char* packed_by_zlib(unsigned char* data, int size, int* packed_size,
                              int /*effort, in stb's measure*/) {
    constexpr int kLevel = 6; // zlib's default; stb requests 8, which is slower than its own compressor
    uLongf most = compressBound(static_cast<uLong>(size));
    auto* packed = static_cast<unsigned char*>(std::malloc(most));
    if (!packed)
        return nullptr;
    if (most > INT_MAX || compress2(packed, &most, data, static_cast<uLong>(size), kLevel) != Z_OK) {
        std::free(packed);
        return nullptr;
    }
    *packed_size = static_cast<int>(most);
    return packed;
}

} // namespace

// Static copy of stb in this file, so that it does not conflict with that of another library.
#define STBIW_ZLIB_COMPRESS packed_by_zlib
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace prt {

namespace {

std::vector<std::byte> encode_channels(int width, int height, int channels, const void* pixels) {
    struct Free {
        void operator()(unsigned char* bytes) const { std::free(bytes); }
    };
    int size = 0;
    const std::unique_ptr<unsigned char, Free> file(stbi_write_png_to_mem(
        static_cast<const unsigned char*>(pixels), channels * width, width, height, channels, &size));
    if (!file)
        throw Error("the image could not be encoded: there is not enough memory");
    const auto* begin = reinterpret_cast<const std::byte*>(file.get());
    return {begin, begin + size};
}

} // namespace

std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec3> pixels) {
    return encode_channels(width, height, 3, pixels.data());
}

std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec4> pixels) {
    return encode_channels(width, height, 4, pixels.data());
}

void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const glm::u8vec3> pixels) {
    OutputFile output(path);
    output.write(encode_png(width, height, pixels));
    output.commit();
}

} // namespace prt
