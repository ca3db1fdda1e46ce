// Reads WebP and AVIF images.
#include "runtime/image/web_images.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"
#include "runtime/image/image_limits.h"

#include <avif/avif.h>
#include <webp/decode.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

namespace prt {
namespace {

const std::uint8_t* bytes_of(std::span<const std::byte> file) {
    return reinterpret_cast<const std::uint8_t*>(file.data());
}

Image8 empty_image(const ImageSize& size) {
    Image8 image{size.width, size.height, {}};
    image.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    return image;
}

/// 16-bit planes with alpha, in the decoder and in its output, plus the pixels.
constexpr std::uint64_t kAvifBytesPerPixel = 2 * 4 * sizeof(std::uint16_t) + sizeof(glm::u8vec4);

struct AvifDestroy {
    void operator()(avifDecoder* decoder) const { avifDecoderDestroy(decoder); }
};
using AvifDecoder = std::unique_ptr<avifDecoder, AvifDestroy>;

void check_avif(avifResult result) {
    if (result != AVIF_RESULT_OK)
        throw Error(std::string("is a damaged or unsupported AVIF: ") +
                    printable(avifResultToString(result)));
}

/// Parses the header of `file`, which must outlive the decoder.
AvifDecoder parsed_avif(std::span<const std::byte> file) {
    AvifDecoder decoder(avifDecoderCreate());
    if (!decoder)
        throw Error("there is not enough memory to read an AVIF");
    decoder->maxThreads = 1;
    decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
    decoder->strictFlags = AVIF_STRICT_DISABLED; // accepts the files that browsers show
    // dav1d also checks the size of the frame, which can be larger than the size in the file's header.
    decoder->imageSizeLimit = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        1u << 28, (kFreeImageMemory + kImageMemoryPerByte * file.size()) / kAvifBytesPerPixel));
    check_avif(avifDecoderSetIOMemory(decoder.get(), bytes_of(file), file.size()));
    check_avif(avifDecoderParse(decoder.get()));
    return decoder;
}

ImageSize size_of(const avifDecoder& decoder, std::size_t file_bytes) {
    check_image_size(decoder.image->width, decoder.image->height, kAvifBytesPerPixel, file_bytes);
    return {static_cast<int>(decoder.image->width), static_cast<int>(decoder.image->height)};
}

} // namespace

ImageSize webp_size(std::span<const std::byte> file) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes_of(file), file.size(), &features) != VP8_STATUS_OK)
        throw Error("is a damaged or unsupported WebP");
    if (features.has_animation)
        throw Error("is an animated WebP, which is not supported; extract one of its frames");
    // For lossless images the decoder holds all pixels, twice if they are transformed.
    check_image_size(features.width, features.height, 3 * sizeof(glm::u8vec4), file.size());
    return {features.width, features.height};
}

Image8 decode_webp(std::span<const std::byte> file) {
    Image8 image = empty_image(webp_size(file));
    if (!WebPDecodeRGBAInto(bytes_of(file), file.size(), reinterpret_cast<std::uint8_t*>(image.pixels.data()),
                            image.pixels.size() * sizeof(glm::u8vec4),
                            image.width * static_cast<int>(sizeof(glm::u8vec4))))
        throw Error(
            "is a damaged WebP: it ends before its last pixel, or its format differs from its header");
    return image;
}

ImageSize avif_size(std::span<const std::byte> file) {
    return size_of(*parsed_avif(file), file.size());
}

Image8 decode_avif(std::span<const std::byte> file) {
    const AvifDecoder decoder = parsed_avif(file);
    Image8 image = empty_image(size_of(*decoder, file.size()));
    check_avif(avifDecoderNextImage(decoder.get()));
    if (decoder->image->width != static_cast<std::uint32_t>(image.width) ||
        decoder->image->height != static_cast<std::uint32_t>(image.height))
        throw Error("is a damaged AVIF: its size differs from its header");
    avifRGBImage pixels;
    avifRGBImageSetDefaults(&pixels, decoder->image);
    pixels.format = AVIF_RGB_FORMAT_RGBA;
    pixels.depth = 8;
    pixels.rowBytes = static_cast<std::uint32_t>(static_cast<std::size_t>(image.width) * sizeof(glm::u8vec4));
    pixels.pixels = reinterpret_cast<std::uint8_t*>(image.pixels.data());
    check_avif(avifImageYUVToRGB(decoder->image, &pixels));
    return image;
}

} // namespace prt
