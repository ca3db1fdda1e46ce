// Compares decoded WebP and AVIF images with the input of their encoders.

#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "runtime/image/image_size.h"

#include <avif/avif.h>
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <span>
#include <string_view>
#include <vector>

namespace prt {
namespace {

constexpr int kWidth = 37, kHeight = 21;

/// Smooth colors, and alpha that is 0 nowhere, as encoders drop colors there.
std::vector<std::uint8_t> pattern() {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (const int v : {6 * x, 11 * y, 255 - 4 * x - 3 * y, 255 - 5 * x})
                pixels.push_back(static_cast<std::uint8_t>(v));
    return pixels;
}

std::vector<std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    return {bytes, bytes + size};
}

std::vector<std::byte> webp_file(bool lossless) {
    const std::vector<std::uint8_t> pixels = pattern();
    std::uint8_t* data = nullptr;
    const std::size_t size = lossless
                                 ? WebPEncodeLosslessRGBA(pixels.data(), kWidth, kHeight, 4 * kWidth, &data)
                                 : WebPEncodeRGBA(pixels.data(), kWidth, kHeight, 4 * kWidth, 95, &data);
    EXPECT_GT(size, 0u);
    std::vector<std::byte> file = bytes_of(data, size);
    WebPFree(data);
    return file;
}

std::vector<std::byte> avif_file(std::uint32_t depth) {
    std::vector<std::uint8_t> pixels = pattern();
    avifImage* image = avifImageCreate(kWidth, kHeight, depth, AVIF_PIXEL_FORMAT_YUV444);
    image->matrixCoefficients = AVIF_MATRIX_COEFFICIENTS_BT601;
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, image);
    rgb.format = AVIF_RGB_FORMAT_RGBA;
    rgb.depth = 8;
    rgb.pixels = pixels.data();
    rgb.rowBytes = 4 * kWidth;
    EXPECT_EQ(avifImageRGBToYUV(image, &rgb), AVIF_RESULT_OK);
    avifEncoder* encoder = avifEncoderCreate();
    encoder->maxThreads = 1;
    encoder->minQuantizer = encoder->maxQuantizer = AVIF_QUANTIZER_LOSSLESS;
    encoder->minQuantizerAlpha = encoder->maxQuantizerAlpha = AVIF_QUANTIZER_LOSSLESS;
    encoder->speed = 8;
    avifRWData output = AVIF_DATA_EMPTY;
    EXPECT_EQ(avifEncoderWrite(encoder, image, &output), AVIF_RESULT_OK);
    std::vector<std::byte> file = bytes_of(output.data, output.size);
    avifRWDataFree(&output);
    avifEncoderDestroy(encoder);
    avifImageDestroy(image);
    return file;
}

/// The largest difference of any channel from the pattern.
int largest_difference(const Image8& image) {
    EXPECT_EQ(image.width, kWidth);
    EXPECT_EQ(image.height, kHeight);
    const std::vector<std::uint8_t> expected = pattern();
    int largest = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 4; ++c)
            largest = std::max(largest,
                               std::abs(image.pixels[i][c] - expected[4 * i + static_cast<std::size_t>(c)]));
    return largest;
}

TEST(WebImages, RoundTripPixels) {
    EXPECT_EQ(largest_difference(decode_image(webp_file(true))), 0);
    EXPECT_LE(largest_difference(decode_image(webp_file(false))), 40); // its colors are of four pixels
    for (const std::uint32_t depth : {8u, 10u, 12u})
        EXPECT_LE(largest_difference(decode_image(avif_file(depth))), 2) << depth; // YUV and back
    EXPECT_EQ(image_size(webp_file(true)).width, kWidth);
    EXPECT_EQ(image_size(avif_file(8)).height, kHeight);
}

TEST(WebImages, TruncationIsRejected) {
    for (const std::vector<std::byte>& whole : {webp_file(true), webp_file(false), avif_file(8)})
        for (std::size_t length = 12; length < whole.size(); length += 7)
            EXPECT_THROW(decode_image(std::span(whole).first(length)), Error) << length;
}

TEST(WebImages, DamagedFilesTerminate) {
    std::mt19937 random(4);
    for (const std::vector<std::byte>& whole : {webp_file(true), webp_file(false), avif_file(8)})
        for (int i = 0; i < 300; ++i) {
            std::vector<std::byte> file = whole;
            for (int k = 0; k < 3; ++k)
                file[12 + random() % (file.size() - 12)] = static_cast<std::byte>(random());
            try {
                decode_image(file);
            } catch (const Error&) { // an error is reported, or not detected
            }
        }
}

TEST(WebImages, ClaimsAreCheckedAgainstTheFileSize) {
    // The header of a lossless WebP that claims 16 384 pixels each way, in a few bytes.
    std::vector<std::byte> file = webp_file(true);
    const std::uint32_t size = 16383u | 16383u << 14;
    for (int i = 0; i < 4; ++i)
        file[21 + static_cast<std::size_t>(i)] = static_cast<std::byte>(size >> (8 * i) & 255);
    EXPECT_THROW(decode_image(file), Error);
    EXPECT_THROW(image_size(file), Error);
}

/// libheif writes the brand of any still image first, and "avif" behind it.
TEST(WebImages, AvifMayHaveAnotherBrandFirst) {
    std::vector<std::byte> file = avif_file(8);
    const std::string_view brand = "mif1";
    std::memcpy(&file[8], brand.data(), brand.size());
    EXPECT_LE(largest_difference(decode_image(file)), 2);
    file[3] = std::byte{16}; // the box ends before its list of brands
    EXPECT_THROW(decode_image(file), Error);
}

} // namespace
} // namespace prt
