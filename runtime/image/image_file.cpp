// Images from files by their kind: Radiance HDR, PNG and JPEG by stb.
#include "prt/image_file.h"

#include "exr.h"
#include "image_kind.h"
#include "image_limits.h"
#include "png_check.h"
#include "prt/image_size.h"
#include "prt/srgb.h"
#include "prt/support/error.h"
#include "prt/support/file.h"
#include "prt/support/printable.h"

#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstring>
#include <memory>
#include <string>

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
        throw Error("the image is larger than 2 GB");
    return static_cast<int>(file.size());
}

/// Hands a file in memory to stb piece by piece, to see whether it asks for more than there is: it would take
/// zeros for what is missing and say nothing, and wait for ever for the end of runs of length zero. What is
/// missing is therefore made up of bytes that end runs.
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

/// What stb and `decode_image` hold at once. Of a JPEG: samples, coefficients of three channels, and pixels;
/// of a PNG: inflated bytes and pixels, then both kinds of pixels.
std::size_t bytes_per_pixel(std::span<const std::byte> file) {
    if (is_jpeg(file))
        return 13;
    return stbi_is_16_bit_from_memory(stb_bytes(file), stb_size(file)) ? 16 : 8;
}

Image read_hdr(std::span<const std::byte> file) {
    const ImageSize size = image_size(file);
    check_image_size(size.width, size.height, 2 * sizeof(glm::vec3), file.size()); // stb's and ours
    Image image;
    int channels = 0;
    const stbi_io_callbacks callbacks{ByteStream::read, ByteStream::skip, ByteStream::eof};
    ByteStream stream{file};
    const std::unique_ptr<float, StbFree> pixels(
        stbi_loadf_from_callbacks(&callbacks, &stream, &image.width, &image.height, &channels, 3));
    if (stream.past_end)
        throw Error("is a damaged Radiance HDR: it ends before its last pixel");
    if (!pixels)
        throw Error(std::string("is a damaged or unsupported Radiance HDR: ") +
                    printable(stbi_failure_reason()));
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * sizeof(glm::vec3));
    return image;
}

EnvironmentLayout layout_of(const Image& image, std::optional<EnvironmentLayout> stated) {
    if (stated)
        return *stated;
    if (image.width == 2 * image.height)
        return EnvironmentLayout::lat_long;
    if (image.height == 6 * image.width)
        return EnvironmentLayout::cube;
    throw Error(
        "is no environment map: it is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
        " pixels and has no envmap attribute (a lat-long map is twice as wide as high, a cube map six "
        "square faces in a column; otherwise its layout has to be said)");
}

/// 8-bit sRGB as linear radiance up to 1.
Image read_low_dynamic_range(std::span<const std::byte> file) {
    const ImageSize size = image_size(file);
    check_image_size(size.width, size.height, sizeof(glm::u8vec4) + sizeof(glm::vec3), file.size());
    const Image8 image = decode_image(file);
    std::array<float, 256> values;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = srgb_decode(static_cast<float>(i) / 255);
    Image result{image.width, image.height, {}};
    result.pixels.reserve(image.pixels.size());
    for (const glm::u8vec4& pixel : image.pixels)
        result.pixels.emplace_back(values[pixel.r], values[pixel.g], values[pixel.b]);
    return result;
}

/// An image, and what it says about itself.
struct AnyImage {
    Image image;
    std::optional<EnvironmentLayout> layout;
    bool low_dynamic_range = false;
};

AnyImage read_any(const std::filesystem::path& path) {
    const std::vector<std::byte> file = read_file(path);
    try {
        if (is_exr(file)) {
            ExrFile exr = read_exr(file);
            return {std::move(exr.image), exr.layout};
        }
        if (is_hdr(file))
            return {read_hdr(file), {}};
        if (is_png(file) || is_jpeg(file))
            return {read_low_dynamic_range(file), {}, true};
        throw Error("is no image that is read here: OpenEXR, Radiance HDR, PNG and JPEG are");
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
}

constexpr std::string_view kFaceMark = "{face}";

/// The six faces of a cube map, of one size, in a column.
Image read_faces(const std::string& pattern, bool& low_dynamic_range) {
    Image column;
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        std::string path = pattern;
        path.replace(path.find(kFaceMark), kFaceMark.size(), face);
        AnyImage file = read_any(path);
        low_dynamic_range |= file.low_dynamic_range;
        const Image image = std::move(file.image);
        if (image.width != image.height || (column.width != 0 && image.width != column.width))
            throw Error(path + ": is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                        " pixels, but the faces of a cube map are squares of one size");
        column.width = image.width;
        column.height += image.height;
        column.pixels.insert(column.pixels.end(), image.pixels.begin(), image.pixels.end());
    }
    return column;
}

} // namespace

EnvironmentFile load_environment(const std::filesystem::path& path, const EnvironmentOptions& options) {
    EnvironmentFile result;
    std::optional<EnvironmentLayout> layout = options.layout;
    if (path.string().find(kFaceMark) != std::string::npos) {
        result.environment.image = read_faces(path.string(), result.low_dynamic_range);
        layout = layout.value_or(EnvironmentLayout::cube_faces);
    } else {
        AnyImage file = read_any(path);
        result.low_dynamic_range = file.low_dynamic_range;
        result.environment.image = std::move(file.image);
        if (!layout)
            layout = file.layout;
    }
    try {
        result.environment.layout = layout_of(result.environment.image, layout);
        result.environment.center = options.center;
        check_environment(result.environment);
        result.repaired_pixels = repair_pixels(result.environment.image, options.bad_pixels);
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
    return result;
}

ImageSize image_size(std::span<const std::byte> file) {
    if (!is_png(file) && !is_jpeg(file) && !is_hdr(file)) // stb reads more kinds, with less care
        throw Error("is no image that is read here: PNG and JPEG are");
    if (is_png(file))
        check_png_chunks(file);
    ImageSize size;
    int channels = 0;
    if (!stbi_info_from_memory(stb_bytes(file), stb_size(file), &size.width, &size.height, &channels))
        throw Error(std::string("is a damaged or unsupported image: ") + printable(stbi_failure_reason()));
    return size;
}

Image8 decode_image(std::span<const std::byte> file) {
    if (is_hdr(file))
        throw Error("is a Radiance HDR, not a PNG or JPEG");
    const ImageSize size = image_size(file);
    check_image_size(size.width, size.height, bytes_per_pixel(file), file.size());
    if (is_png(file))
        check_png(file, size);
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
