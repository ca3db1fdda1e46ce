// Images that lie, end early, never end, or are too bright.
#include "prt/core/environment.h"
#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "runtime/image/exr.h"
#include "runtime/image/image_limits.h"
#include "runtime/image/png_check.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <thread>

#include <malloc.h>
#include <sys/resource.h>
#include <sys/stat.h>

namespace prt {
namespace {

/// Returns the error of reading the file as an environment; empty if it is read.
std::string refusal(const std::filesystem::path& path) {
    try {
        load_environment(path, {EnvironmentLayout::lat_long});
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.what();
    }
    return {};
}

std::string hdr_header(const std::string& size) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
}

/// 16 x 8 pixels: rows of runs, or of single pixels.
std::string hdr(bool runs) {
    std::string file = hdr_header("-Y 8 +X 16");
    for (int y = 0; y < 8; ++y) {
        file += std::string("\x02\x02\x00\x10", 4);
        for (int channel = 0; channel < 4; ++channel)
            file += runs ? std::string("\x90\x80") : "\x10" + std::string(16, '\x80');
    }
    return file;
}

TEST(HdrFile, TruncationIsRejected) {
    const test::TemporaryFolder folder;
    for (const bool runs : {true, false}) {
        const std::string whole = hdr(runs);
        EXPECT_EQ(refusal(folder.file("whole.hdr", whole)), "");
        for (std::size_t length = 1; length < whole.size(); ++length)
            EXPECT_NE(refusal(folder.file("cut.hdr", whole.substr(0, length))), "") << length;
    }
}

TEST(HdrFile, EmptyRunsTerminate) {
    const test::TemporaryFolder folder;
    const std::string zeros = hdr_header("-Y 8 +X 16") + std::string("\x02\x02\x00\x10", 4);
    EXPECT_NE(refusal(folder.file("zeros.hdr", zeros + std::string(1000, '\0'))), "");
}

TEST(HdrFile, ClaimsAreCheckedAgainstTheFileSize) {
    const test::TemporaryFolder folder;
    EXPECT_NE(refusal(folder.file("large.hdr", hdr_header("-Y 8192 +X 16384"))).find("claims 16384 x 8192"),
              std::string::npos);
    // 192 MB hold 2^23 pixels of three floats, stb's and ours.
    EXPECT_NE(refusal(folder.file("more.hdr", hdr_header("-Y 2048 +X 4100"))).find("claims 4100 x 2048"),
              std::string::npos);
    EXPECT_NE(refusal(folder.file("none.hdr", hdr_header("-Y 0 +X 0"))).find("no pixels"), std::string::npos);
    EXPECT_NE(refusal(folder.file("less.hdr", hdr_header("-Y -4 +X 8"))), "");
}

/// The header of an EXR with `value` at `offset` of the value of an attribute.
std::string exr_with(const test::TemporaryFolder& folder, const std::string& attribute, std::size_t offset,
                     std::int32_t value) {
    write_exr(folder / "small.exr", Image{8, 4, std::vector<glm::vec3>(32, glm::vec3(1))},
              EnvironmentLayout::lat_long);
    const auto bytes = read_file(folder / "small.exr");
    std::string file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::memcpy(&file[file.find(attribute) + attribute.size() + offset], &value, sizeof(value));
    return file;
}

TEST(ExrFile, ClaimsAreCheckedAgainstTheFileSize) {
    const test::TemporaryFolder folder;
    const std::string window("dataWindow\0box2i\0", 17);
    const std::size_t kWidth = 4 + 8,
                      kHeight = 4 + 12; // behind the attribute's size: the last column and row
    for (const std::size_t side : {kWidth, kHeight})
        for (const std::int32_t last :
             {100'000'000, 2'000'000'000, std::numeric_limits<std::int32_t>::max(), -7})
            EXPECT_NE(refusal(folder.file("large.exr", exr_with(folder, window, side, last))), "") << last;
    const std::string channels("channels\0chlist\0", 16);
    EXPECT_NE(refusal(folder.file("channels.exr", exr_with(folder, channels, 0, 2'000'000'000))), "");
    std::string untyped = exr_with(folder, channels, 0, 55); // the value is written unchanged
    untyped.insert(8, std::string("odd\0\0", 5) + "\1\2\3\x70");
    EXPECT_NE(refusal(folder.file("untyped.exr", untyped)).find("an attribute claims"), std::string::npos);
    for (const std::string& attribute : {window, channels})
        EXPECT_NE(refusal(folder.file("long.exr", exr_with(folder, attribute, 0, 70))).find("70 bytes"),
                  std::string::npos);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 400'000) << "kilobytes";
}

TEST(ExrFile, IsDetectedByItsFirstFourBytes) {
    const std::string file("\x76\x2f\x31\x01\x02", 5), other("\x76\x2f\x31\x02\x02", 5);
    for (std::size_t length = 0; length <= file.size(); ++length)
        EXPECT_EQ(is_exr(std::as_bytes(std::span(file)).first(length)), length >= 4) << length;
    EXPECT_FALSE(is_exr(std::as_bytes(std::span(other))));
}

TEST(ExrFile, TruncationIsRejectedAndChangedBytesAreReadOrRejected) {
    const test::TemporaryFolder folder;
    const std::string whole = exr_with(folder, std::string("screenWindowWidth\0float\0", 24), 4, 0x3f800000);
    EXPECT_EQ(refusal(folder.file("whole.exr", whole)), "");
    for (std::size_t i = 4; i < whole.size(); i += 3) {
        EXPECT_NE(refusal(folder.file("cut.exr", whole.substr(0, i))), "") << i;
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ (1 << i % 7));
        refusal(folder.file("changed.exr", changed));
    }
}

TEST(Png, ClaimsAreCheckedAgainstTheFileSize) {
    const test::TemporaryFolder folder;
    std::string file("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\x06\0\0\0....", 33);
    EXPECT_NE(refusal(folder.file("large.png", file)).find("claims 16384 x 16384"), std::string::npos);
    EXPECT_THROW(decode_image(std::as_bytes(std::span(file))), Error);
}

/// A chunk of a PNG, without a true checksum, which stb does not look at.
std::string chunk(const std::string& type, const std::string& contents) {
    std::string length(4, '\0');
    for (std::size_t i = 0; i < 4; ++i)
        length[i] = static_cast<char>(contents.size() >> (24 - 8 * i) & 255u);
    return length + type + contents + "....";
}

/// Zeros by deflate, 258 for each two bits (RFC 1951: a literal, then matches of distance 1).
std::string inflating_zeros(std::size_t bytes) {
    std::string stream("\x78\xda\xec\xc1\x01\x01\0\0\0\x80\x90\xfe\xaf\xee\x08\x0a", 16);
    return stream + std::string(bytes, '\0');
}

TEST(ImageLimits, HoldToTheLastPixelAndByte) {
    constexpr std::int64_t kSide = 1 << 14; // its square is the maximum
    EXPECT_NO_THROW(check_image_size(kSide, kSide, 0, 0));
    EXPECT_THROW(check_image_size(kSide + 1, kSide, 0, 0), Error);
    EXPECT_NO_THROW(check_image_size(kSide * kSide, 1, 0, 0));
    EXPECT_THROW(check_image_size(1, kSide * kSide + 1, 0, 0), Error);
    constexpr std::uint64_t kMax = kFreeImageMemory + 10 * kImageMemoryPerByte;
    EXPECT_NO_THROW(check_image_size(2, 3, kMax / 6, 10, kMax % 6));
    EXPECT_THROW(check_image_size(2, 3, kMax / 6, 10, kMax % 6 + 1), Error);
    EXPECT_THROW(check_image_size(0, 1, 1, 1), Error);
    EXPECT_THROW(check_image_size(1, 0, 1, 1), Error);
}

TEST(Png, ExcessiveInflatedDataIsRejected) {
    const std::string header =
        std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", std::string("\0\0\0\x10\0\0\0\x10\x08\2\0\0\0", 13));
    const std::string bomb = header + chunk("IDAT", inflating_zeros(1 << 20)) + chunk("IEND", "");
    EXPECT_THROW(decode_image(std::as_bytes(std::span(bomb))), Error);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 400'000) << "kilobytes";
}

/// Returns `bytes` as an uncompressed zlib stream (RFC 1950 and 1951), without a valid checksum.
std::string stored(const std::string& bytes) {
    const auto low = static_cast<char>(bytes.size() & 255u), high = static_cast<char>(bytes.size() >> 8);
    return std::string("\x78\x01\x01", 3) + low + high + static_cast<char>(~low) + static_cast<char>(~high) +
           bytes + "....";
}

/// Leaves values on the stack where the next function has its variables.
[[gnu::noinline]] void soil_stack() {
    volatile char soil[1 << 16];
    for (volatile char& byte : soil)
        byte = 'x';
}

TEST(Png, HasNoBitDepthIfTruncated) {
    const std::string file =
        std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", std::string("\0\0\0\4\0\0\0\1\x10\2\0\0\0", 13));
    const auto bytes = std::as_bytes(std::span(file));
    constexpr std::size_t kDepth = 8 + 8 + 8; // magic number, length and type, width and height
    for (std::size_t length = 8; length <= bytes.size(); ++length)
        EXPECT_EQ(png_bit_depth(bytes.first(length)), length > kDepth ? 16 : 0) << length;
}

TEST(Png, ColorsBeyondThePaletteAreBlack) {
    const std::string file = std::string("\x89PNG\r\n\x1a\n") +
                             chunk("IHDR", std::string("\0\0\0\4\0\0\0\1\x08\3\0\0\0", 13)) +
                             chunk("PLTE", "abcdef") + chunk("tRNS", "\x80") +
                             chunk("IDAT", stored(std::string("\0\0\1\2\xff", 5))) + chunk("IEND", "");
    soil_stack();
    const Image8 image = decode_image(std::as_bytes(std::span(file)));
    ASSERT_EQ(image.pixels.size(), 4u);
    EXPECT_EQ(image.pixels[0], glm::u8vec4('a', 'b', 'c', 0x80));
    EXPECT_EQ(image.pixels[1], glm::u8vec4('d', 'e', 'f', 255));
    for (int i : {2, 3})
        EXPECT_EQ(image.pixels[static_cast<std::size_t>(i)], glm::u8vec4(0, 0, 0, 255));
}

/// A part of a JPEG, behind its length.
std::string segment(char marker, const std::string& contents) {
    const std::size_t length = contents.size() + 2;
    return std::string("\xff") + marker + static_cast<char>(length >> 8) + static_cast<char>(length & 255u) +
           contents;
}

TEST(Jpeg, UninitializedMemoryIsNotVisible) {
    const std::string start("\xff\xd8"), end("\xff\xd9");
    const std::string frame = segment('\xc0', std::string("\x08\0\x08\0\x08\1\1\x11\0", 9)); // 8 x 8, grey
    const std::string none = start + frame + end;
    EXPECT_THROW(decode_image(std::as_bytes(std::span(none))), Error) << "without a scan";
    // One code of one bit in each table: a difference of one bit, and the end of the block. There is no table
    // of quantisation.
    const std::string counts = std::string("\1", 1) + std::string(15, '\0');
    const std::string tables = segment('\xc4', std::string(1, '\0') + counts + '\1') +
                               segment('\xc4', "\x10" + counts + std::string(1, '\0'));
    const std::string scan = segment('\xda', std::string("\1\1\0\0\x3f\0", 6)) + "\x5f";
    const std::string file = start + frame + tables + scan + end;
    for (const int soil : {0x55, 0xaa}) {
        mallopt(M_PERTURB, soil);
        const Image8 image = decode_image(std::as_bytes(std::span(file)));
        mallopt(M_PERTURB, 0);
        ASSERT_EQ(image.pixels.size(), 64u);
        for (const glm::u8vec4& pixel : image.pixels)
            EXPECT_EQ(pixel, glm::u8vec4(128, 128, 128, 255));
    }
}

TEST(Png, BytesOfTheFileInMessagesArePrintable) {
    const test::TemporaryFolder folder;
    std::string file("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\1\x08\6\0\0\0....\0\0\0\4A\x1b\n\x80", 41);
    const std::string message = refusal(folder.file("chunk.png", file + std::string(12, '\0')));
    EXPECT_NE(message.find("critical chunk"), std::string::npos) << message;
    for (const char c : message)
        EXPECT_TRUE(c >= ' ' && c <= '~') << message;
}

TEST(Project, LightBeyondTheValidRangeIsRejected) {
    for (const EnvironmentLayout layout :
         {EnvironmentLayout::lat_long, EnvironmentLayout::angular, EnvironmentLayout::cube}) {
        const int height = layout == EnvironmentLayout::cube ? 48 : 8;
        for (const float radiance : {3e38f, 1e25f}) {
            const Image image{
                8, height, std::vector<glm::vec3>(static_cast<std::size_t>(8 * height), glm::vec3(radiance))};
            EXPECT_THROW(project({image, layout}, 6), Error) << radiance;
        }
    }
}

TEST(LoadEnvironment, ReadsPipesAndRejectsEndlessFiles) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "sky.hdr").c_str(), 0600), 0);
    EXPECT_NE(refusal(folder / "sky.hdr").find("no data arrives"), std::string::npos);
    std::thread writer([&] { std::ofstream(folder / "sky.hdr", std::ios::binary) << hdr(true); });
    EXPECT_EQ(refusal(folder / "sky.hdr"), "");
    writer.join();
    EXPECT_NE(refusal("/dev/zero").find("not a regular file or a pipe"), std::string::npos);
}

} // namespace
} // namespace prt
