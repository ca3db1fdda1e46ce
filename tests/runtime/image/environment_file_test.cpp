// Tests environment files: layouts, formats and their pixels.

#include "prt/image/image_file.h"

#include "prt/core/error.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/file.h"
#include "support/temporary_folder.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <sys/resource.h>

namespace prt {
namespace {

TEST(Cube, DirectionsMatchOpenExr) {
    constexpr int kSize = 9;
    const Imath::Box2i window({0, 0}, {kSize - 1, 6 * kSize - 1});
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const auto f = static_cast<Imf::CubeMapFace>(face);
                const Imath::V3f d = Imf::CubeMap::direction(f, window, {float(x), float(y)}).normalized();
                const Imath::V2f p = Imf::CubeMap::pixelPosition(f, window, {float(x), float(y)});
                const glm::dvec3 ours = cube_direction(face, 2.0 * p.x / (kSize - 1) - 1,
                                                       2.0 * (p.y - float(face * kSize)) / (kSize - 1) - 1);
                EXPECT_LT(glm::distance(ours, glm::dvec3(d.x, d.y, d.z)), 1e-6)
                    << face << " " << x << " " << y;
            }
}

TEST(LatLong, DirectionsMatchOpenExrExceptHalfATexel) {
    // OpenEXR puts the centers of the border texels on the border; with that undone both agree.
    constexpr int kWidth = 17, kHeight = 9;
    const Imath::Box2i window({0, 0}, {kWidth - 1, kHeight - 1});
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Imath::V3f d = Imf::LatLongMap::direction(window, Imath::V2f(float(x), float(y)));
            EXPECT_LT(
                glm::distance(lat_long_direction(kWidth - 1, kHeight - 1, x, y), glm::dvec3(d.x, d.y, d.z)),
                1e-6);
        }
}

struct ExrKind {
    const char* name;
    Imf::PixelType type;
    Imf::Compression compression;
    bool tiled, grey;
};
void PrintTo(const ExrKind& kind, std::ostream* out) {
    *out << kind.name;
}
class Exr : public testing::TestWithParam<ExrKind> {};
INSTANTIATE_TEST_SUITE_P(
    Kinds, Exr,
    testing::Values(ExrKind{"half_none", Imf::HALF, Imf::NO_COMPRESSION, false, false},
                    ExrKind{"half_piz", Imf::HALF, Imf::PIZ_COMPRESSION, false, false},
                    ExrKind{"half_rle", Imf::HALF, Imf::RLE_COMPRESSION, false, false},
                    ExrKind{"float_zip", Imf::FLOAT, Imf::ZIP_COMPRESSION, false, false},
                    ExrKind{"float_zips_tiled", Imf::FLOAT, Imf::ZIPS_COMPRESSION, true, false},
                    ExrKind{"float_pxr24", Imf::FLOAT, Imf::PXR24_COMPRESSION, false, false},
                    ExrKind{"half_b44", Imf::HALF, Imf::B44_COMPRESSION, false, false},
                    ExrKind{"half_b44a_tiled", Imf::HALF, Imf::B44A_COMPRESSION, true, false},
                    ExrKind{"half_dwaa", Imf::HALF, Imf::DWAA_COMPRESSION, false, false},
                    ExrKind{"half_dwab", Imf::HALF, Imf::DWAB_COMPRESSION, false, false},
                    ExrKind{"uint_zip", Imf::UINT, Imf::ZIP_COMPRESSION, false, false},
                    ExrKind{"grey_half", Imf::HALF, Imf::ZIP_COMPRESSION, false, true},
                    ExrKind{"grey_float_tiled", Imf::FLOAT, Imf::ZIP_COMPRESSION, true, true}),
    [](const auto& kind) { return kind.param.name; });

TEST_P(Exr, AllChannelTypesAndCompressionsAreRead) {
    const ExrKind kind = GetParam();
    const test::TemporaryFolder folder;
    const std::string path = (folder / "e.exr").string();
    constexpr int kWidth = 40, kHeight = 20;
    const char* names[3] = {"R", "G", "B"};
    const int channels = kind.grey ? 1 : 3;
    std::vector<float> floats;
    std::vector<half> halves;
    std::vector<unsigned> integers;
    for (int i = 0; i < kWidth * kHeight * 3; ++i) {
        const int pixel = i / 3,
                  value = 2 + (pixel % kWidth) / 8 + 4 * (pixel / kWidth / 10) + i % 3; // smooth blocks
        floats.push_back(static_cast<float>(value));
        halves.emplace_back(static_cast<float>(value));
        integers.push_back(static_cast<unsigned>(value));
    }
    Imf::Header header(kWidth, kHeight);
    header.dataWindow() = Imath::Box2i({-3, 5}, {kWidth - 4, kHeight + 4}); // not at the origin
    header.compression() = kind.compression;
    if (kind.tiled)
        header.setTileDescription(Imf::TileDescription(16, 16, Imf::MIPMAP_LEVELS));
    Imf::FrameBuffer buffer;
    for (int c = 0; c < channels; ++c) {
        const char* name = kind.grey ? "Y" : names[c];
        header.channels().insert(name, Imf::Channel(kind.type));
        char* base = kind.type == Imf::FLOAT ? reinterpret_cast<char*>(&floats[static_cast<std::size_t>(c)])
                     : kind.type == Imf::HALF
                         ? reinterpret_cast<char*>(&halves[static_cast<std::size_t>(c)])
                         : reinterpret_cast<char*>(&integers[static_cast<std::size_t>(c)]);
        const std::size_t size = kind.type == Imf::HALF ? 2 : 4;
        buffer.insert(name,
                      Imf::Slice::Make(kind.type, base, header.dataWindow(), 3 * size, 3 * size * kWidth));
    }
    if (kind.tiled) {
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(kHeight);
    }
    const Environment environment = load_environment(path).environment;
    ASSERT_EQ(environment.image.width, kWidth);
    ASSERT_EQ(environment.image.height, kHeight);
    EXPECT_EQ(environment.layout, EnvironmentLayout::lat_long);
    const bool lossy = kind.compression == Imf::B44_COMPRESSION ||
                       kind.compression == Imf::B44A_COMPRESSION ||
                       kind.compression == Imf::DWAA_COMPRESSION || kind.compression == Imf::DWAB_COMPRESSION;
    for (std::size_t i = 0; i < environment.image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float expected = floats[3 * i + static_cast<std::size_t>(kind.grey ? 0 : c)];
            EXPECT_NEAR(environment.image.pixels[i][c], expected, lossy ? 0.05f * expected : 0);
        }
}

TEST(EnvironmentFile, FloatsBeyondHalfSurvive) {
    const test::TemporaryFolder folder;
    Image image{4, 2, std::vector<glm::vec3>(8, glm::vec3(1e5f, 3e6f, 1e-9f))};
    write_exr(folder / "sun.exr", image);
    const auto read = load_environment(folder / "sun.exr").environment.image;
    EXPECT_EQ(read.pixels, image.pixels);
}

TEST(EnvironmentFile, LuminanceChromaIsRead) {
    const test::TemporaryFolder folder;
    const std::string path = (folder / "yc.exr").string();
    {
        const std::vector<Imf::Rgba> pixels(32 * 16, Imf::Rgba(0.5f, 1.0f, 2.0f));
        Imf::RgbaOutputFile file(path.c_str(), 32, 16, Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, 32);
        file.writePixels(16);
    }
    for (const glm::vec3& pixel : load_environment(path).environment.image.pixels)
        EXPECT_LT(glm::distance(pixel, glm::vec3(0.5f, 1, 2)), 0.02f);
}

/// Writes the named channels, 1 everywhere.
void write_channels(const std::string& path, const std::vector<const char*>& names) {
    Imf::Header header(4, 2);
    Imf::FrameBuffer buffer;
    std::vector<float> ones(8, 1.0f);
    for (const char* name : names) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(ones.data()), sizeof(float),
                                       4 * sizeof(float)));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
}

TEST(EnvironmentFile, ColorsHavePriorityOverLuminanceChroma) {
    const test::TemporaryFolder folder;
    const std::string path = (folder / "channels.exr").string();
    const std::pair<std::vector<const char*>, glm::vec3> cases[] = {
        {{"Y"}, {1, 1, 1}},
        {{"Y", "G", "B"}, {0, 1, 1}},
        {{"R"}, {1, 0, 0}},
        {{"R", "G", "B", "RY"}, {1, 1, 1}},
        {{"R", "G", "B", "Y", "RY", "BY"}, {1, 1, 1}}};
    for (const auto& [names, expected] : cases) {
        write_channels(path, names);
        for (const glm::vec3& pixel : load_environment(path).environment.image.pixels)
            EXPECT_EQ(pixel, expected) << names.front() << names.size();
    }
    write_channels(path, {"RY", "BY"});
    EXPECT_THROW(load_environment(path), Error);
}

TEST(EnvironmentFile, OtherPrimariesAreConverted) {
    const test::TemporaryFolder folder;
    const std::string path = (folder / "xyz.exr").string();
    {
        Imf::Header header(4, 2);
        // Primaries of CIE XYZ: pixels are tristimulus values.
        Imf::addChromaticities(header, Imf::Chromaticities({1, 0}, {0, 1}, {0, 0}, {1 / 3.f, 1 / 3.f}));
        const std::vector<Imf::Rgba> pixels(8, Imf::Rgba(0.95047f, 1.0f, 1.08883f)); // D65 white
        Imf::RgbaOutputFile file(path.c_str(), header, Imf::WRITE_RGB);
        file.setFrameBuffer(pixels.data(), 1, 4);
        file.writePixels(2);
    }
    for (const glm::vec3& pixel : load_environment(path).environment.image.pixels)
        EXPECT_LT(glm::distance(pixel, glm::vec3(1)), 0.01f);
}

TEST(EnvironmentFile, TheAttributeDecidesThenTheShape) {
    const test::TemporaryFolder folder;
    const auto image = [](int width, int height) {
        return Image{width, height,
                     std::vector<glm::vec3>(static_cast<std::size_t>(width * height), glm::vec3(1))};
    };
    write_exr(folder / "a.exr", image(5, 30));
    EXPECT_EQ(load_environment(folder / "a.exr").environment.layout, EnvironmentLayout::cube);
    write_exr(folder / "b.exr", image(5, 30), EnvironmentLayout::lat_long);
    EXPECT_EQ(load_environment(folder / "b.exr").environment.layout, EnvironmentLayout::lat_long);
    write_exr(folder / "c.exr", image(1, 1), EnvironmentLayout::lat_long);
    EXPECT_EQ(load_environment(folder / "c.exr").environment.image.pixels.size(), 1u);
    write_exr(folder / "d.exr", image(7, 5));
    EXPECT_THROW(load_environment(folder / "d.exr"), Error);
    EXPECT_NO_THROW(load_environment(folder / "d.exr", {EnvironmentLayout::lat_long, BadPixels::error}));
    EXPECT_THROW(load_environment(folder / "d.exr", {EnvironmentLayout::cube, BadPixels::error}), Error);
}

TEST(EnvironmentFile, SixFacesMakeACube) {
    const test::TemporaryFolder folder;
    const auto square = [](int size, float value) {
        return Image{size, size,
                     std::vector<glm::vec3>(static_cast<std::size_t>(size * size), glm::vec3(value))};
    };
    const char* const faces[] = {"px", "nx", "py", "ny", "pz", "nz"};
    for (int f = 0; f < 6; ++f)
        write_exr(folder / (std::string("sky_") + faces[f] + ".exr"), square(4, static_cast<float>(f + 1)));
    const Environment cube = load_environment(folder / "sky_{face}.exr").environment;
    EXPECT_EQ(cube.layout, EnvironmentLayout::cube_faces);
    EXPECT_EQ(cube.image.height, 24);
    EXPECT_EQ(sample(cube, {1, 0, 0}), glm::vec3(1));
    EXPECT_EQ(sample(cube, {0, -1, 0}), glm::vec3(4));
    EXPECT_EQ(sample(cube, {0, 0, -1}), glm::vec3(6));

    const auto message = [&] {
        try {
            load_environment(folder / "sky_{face}.exr");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    write_exr(folder / "sky_py.exr", square(3, 1));
    EXPECT_NE(message().find("sky_py.exr"), std::string::npos);
    std::filesystem::remove(folder / "sky_py.exr");
    EXPECT_NE(message().find("sky_py.exr"), std::string::npos);
    write_exr(folder / "probe.exr", square(8, 1));
    EXPECT_EQ(load_environment(folder / "probe.exr", {EnvironmentLayout::angular, BadPixels::error})
                  .environment.layout,
              EnvironmentLayout::angular);
    write_exr(folder / "wide.exr", Image{8, 4, std::vector<glm::vec3>(32, glm::vec3(1))});
    EXPECT_THROW(load_environment(folder / "wide.exr", {EnvironmentLayout::angular, BadPixels::error}),
                 Error);
}

TEST(EnvironmentFile, NonImagesAreReported) {
    const test::TemporaryFolder folder;
    folder.file("text.hdr", "hello");
    folder.file("cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\nabc");
    folder.file("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 200000\nabc");
    for (const char* name : {"text.hdr", "cut.hdr", "huge.hdr"})
        try {
            load_environment(folder / name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
}

TEST(EnvironmentFile, DamagedExrsAreRejectedOrFinite) {
    const auto folder = test::shared_file("bad/exr");
    if (folder.empty())
        GTEST_SKIP() << "the damaged files are not here";
    int refused = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        try {
            const Light light = project(
                load_environment(entry.path(), {EnvironmentLayout::lat_long, BadPixels::zero}).environment,
                3);
            for (const glm::vec3& c : light.coefficients)
                EXPECT_TRUE(std::isfinite(c.r + c.g + c.b)) << entry.path();
        } catch (const Error& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            EXPECT_TRUE(std::string(error.what()).starts_with(entry.path().string())) << error.what();
        }
    }
    EXPECT_GT(refused, 20);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 1'000'000) << "kilobytes";
}

TEST(EnvironmentFile, CubeAndLatLongOfOneSceneMatch) {
    const auto lat_long = test::shared_file("env/KernerEnvLatLong.exr"),
               cube = test::shared_file("env/KernerEnvCube.exr");
    if (lat_long.empty() || cube.empty())
        GTEST_SKIP() << "the sample environments are not here";
    const Light a = project(load_environment(lat_long).environment, 6),
                b = project(load_environment(cube).environment, 6);
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
        const glm::dvec3 d(a.coefficients[i] - b.coefficients[i]), c(a.coefficients[i]);
        difference += glm::dot(d, d);
        norm += glm::dot(c, c);
    }
    RecordProperty("relative_l2", std::to_string(std::sqrt(difference / norm)));
    EXPECT_LT(std::sqrt(difference / norm), 0.01);
}

TEST(EnvironmentFile, PhotographsAreRejected) {
    const auto photograph = test::shared_file("env/memorial.exr");
    if (photograph.empty())
        GTEST_SKIP() << "the photograph is not here";
    EXPECT_THROW(load_environment(photograph), Error);
}

TEST(Png, RoundTrips) {
    const test::TemporaryFolder folder;
    std::vector<glm::u8vec3> pixels;
    for (int i = 0; i < 35; ++i)
        pixels.emplace_back(i * 7, 255 - i, i);
    write_png(folder / "p.png", 7, 5, pixels);
    const Image8 read = decode_image(read_file(folder / "p.png"));
    ASSERT_EQ(read.width, 7);
    ASSERT_EQ(read.height, 5);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        EXPECT_EQ(glm::u8vec3(read.pixels[i]), pixels[i]);
}

TEST(LoadEnvironment, EightBitSkiesAreReadAsSrgb) {
    const test::TemporaryFolder folder;
    const std::vector<glm::u8vec3> pixels = {{0, 10, 128}, {255, 200, 188}};
    write_png(folder / "sky.png", 2, 1, pixels);
    const EnvironmentFile file = load_environment(folder / "sky.png");
    EXPECT_TRUE(file.low_dynamic_range);
    for (std::size_t p = 0; p < 2; ++p)
        for (int c = 0; c < 3; ++c) {
            const double v = pixels[p][c] / 255.0; // IEC 61966-2-1
            const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
            EXPECT_NEAR(static_cast<double>(file.environment.image.pixels[p][c]), linear, 1e-6);
        }
    write_exr(folder / "sky.exr", file.environment.image);
    EXPECT_FALSE(load_environment(folder / "sky.exr").low_dynamic_range);
    folder.file("sky.jpg", "\xff\xd8\xff no picture");
    EXPECT_THROW(load_environment(folder / "sky.jpg"), Error);
}

} // namespace
} // namespace prt
