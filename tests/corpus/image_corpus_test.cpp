// Tests environment maps as programs write them: one small file for each deviation, with the exact result.
#include "prt/image/image_file.h"

#include "prt/core/error.h"
#include "support/temporary_folder.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace prt {
namespace {

constexpr int kWidth = 4, kHeight = 2;

/// Pixel of a small sky, exact in RGBE: 0.5 and above with steps of 1/256.
glm::vec3 sky(int x, int y) {
    return {static_cast<float>(128 + x) / 256, static_cast<float>(192 + y) / 256, 0.5f};
}

std::string rgbe(const glm::vec3& color) { // its largest component must be in [0.5, 1)
    std::string bytes;
    for (int c = 0; c < 3; ++c)
        bytes += static_cast<char>(static_cast<unsigned char>(color[c] * 256));
    return bytes + '\x80';
}

/// A Radiance picture of `sky`. `variables` are lines of the header, `resolution` decides the order of
/// pixels.
std::string radiance(const std::string& variables, const std::string& resolution) {
    std::string file = "#?RADIANCE\n" + variables + "\n" + resolution + "\n";
    const bool columns = resolution[1] == 'X';
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const std::size_t second = resolution.find_first_of("XY", 2);
        const int inner = columns ? kHeight : kWidth;
        const bool flip_outer = resolution[0] != (columns ? '+' : '-'),
                   flip_inner = resolution[second - 1] != (columns ? '-' : '+');
        const int outer = columns ? kWidth : kHeight;
        const int a = flip_outer ? outer - 1 - i / inner : i / inner,
                  b = flip_inner ? inner - 1 - i % inner : i % inner;
        file += rgbe(columns ? sky(a, b) : sky(b, a));
    }
    return file;
}

EnvironmentFile read(const std::string& name, const std::string& bytes) {
    const test::TemporaryFolder folder;
    return load_environment(folder.file(name, bytes));
}

void expect_sky(const EnvironmentFile& file, const glm::vec3& scale) {
    const Image& image = file.environment.image;
    ASSERT_EQ(image.width, kWidth);
    ASSERT_EQ(image.height, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            EXPECT_LT(
                glm::distance(image.pixels[static_cast<std::size_t>(y * kWidth + x)], sky(x, y) * scale),
                1e-6f)
                << x << " " << y;
}

constexpr const char* kRgbe = "FORMAT=32-bit_rle_rgbe";

std::string lines(std::initializer_list<const char*> texts) {
    std::string result;
    for (const char* text : texts) {
        result += text;
        result += '\n';
    }
    return result;
}

TEST(ImageCorpus, RadiancePlain) {
    const EnvironmentFile file = read("a.hdr", radiance(lines({kRgbe}), "-Y 2 +X 4"));
    expect_sky(file, glm::vec3(1));
    EXPECT_TRUE(file.notices.empty());
}

TEST(ImageCorpus, RadiancePfiltExposuresMultiply) {
    const EnvironmentFile file = read(
        "a.hdr", radiance(lines({"EXPOSURE=4", "VIEW= -vta", kRgbe, "EXPOSURE=  5.0e-01"}), "-Y 2 +X 4"));
    expect_sky(file, glm::vec3(0.5f));
    EXPECT_EQ(file.notices.size(), 1u);
}

TEST(ImageCorpus, RadiancePcondColorCorrection) {
    const EnvironmentFile file = read("a.hdr", radiance(lines({"COLORCORR= 2 1 0.5", kRgbe}), "-Y 2 +X 4"));
    expect_sky(file, {0.5f, 1, 2});
    EXPECT_EQ(file.notices.size(), 1u);
}

TEST(ImageCorpus, InvalidRadianceExposureIsRejected) {
    for (const char* line : {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=bright", "EXPOSURE=", "EXPOSURE=inf"})
        EXPECT_THROW(read("a.hdr", radiance(lines({line, kRgbe}), "-Y 2 +X 4")), Error) << line;
}

TEST(ImageCorpus, RadianceProtateOrientations) {
    for (const char* resolution : {"-Y 2 +X 4", "-Y 2 -X 4", "+Y 2 +X 4", "+Y 2 -X 4", "+X 4 -Y 2",
                                   "+X 4 +Y 2", "-X 4 -Y 2", "-X 4 +Y 2"}) {
        SCOPED_TRACE(resolution);
        expect_sky(read("a.hdr", radiance(lines({kRgbe}), resolution)), glm::vec3(1));
    }
}

TEST(ImageCorpus, RadianceRaXyze) {
    // X = Y = Z = 0.5 is the white of equal energy; Rec. 709 by the matrix of IEC 61966-2-1, rounded there.
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 4\n";
    for (int i = 0; i < kWidth * kHeight; ++i)
        file += rgbe(glm::vec3(0.5f));
    const EnvironmentFile read_back = read("a.hdr", file);
    const glm::vec3 expected = 0.5f * glm::vec3(3.2406f - 1.5372f - 0.4986f, -0.9689f + 1.8758f + 0.0415f,
                                                0.0557f - 0.2040f + 1.0570f);
    EXPECT_LT(glm::distance(read_back.environment.image.pixels[3], expected), 3e-4f);
}

EnvironmentOptions with_layer(const std::string& layer) {
    EnvironmentOptions options;
    options.layer = layer;
    return options;
}

/// Channels of one value each.
using Channels = std::vector<std::pair<std::string, float>>;

void write_part(const std::filesystem::path& path, const Imath::Box2i& display, const Imath::Box2i& data,
                const Channels& channels) {
    Imf::Header header(display, data);
    std::vector<std::vector<float>> values;
    Imf::FrameBuffer buffer;
    const auto pixels =
        static_cast<std::size_t>((data.max.x - data.min.x + 1) * (data.max.y - data.min.y + 1));
    for (const auto& [name, value] : channels) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        values.emplace_back(pixels, value);
    }
    for (std::size_t i = 0; i < channels.size(); ++i)
        buffer.insert(channels[i].first, Imf::Slice::Make(Imf::FLOAT, values[i].data(), data));
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(data.max.y - data.min.y + 1);
}

const Imath::Box2i kWindow({0, 0}, {kWidth - 1, kHeight - 1});

/// The first pixel of a file with these channels, read with `layer`; `notices` gets their number.
glm::vec3 first_pixel(const Channels& channels, const std::string& layer, std::size_t& notices) {
    const test::TemporaryFolder folder;
    write_part(folder / "a.exr", kWindow, kWindow, channels);
    const EnvironmentFile file = load_environment(folder / "a.exr", with_layer(layer));
    notices = file.notices.size();
    return file.environment.image.pixels.at(0);
}

std::string refusal_of(const Channels& channels, const std::string& layer) {
    std::size_t notices = 0;
    try {
        first_pixel(channels, layer, notices);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(ImageCorpus, BlenderMultilayerExr) {
    const Channels channels = {{"View.Combined.R", 1},
                               {"View.Combined.G", 2},
                               {"View.Combined.B", 3},
                               {"View.Combined.A", 1},
                               {"View.Depth.Z", 9}};
    std::size_t notices = 0;
    EXPECT_EQ(first_pixel(channels, "", notices), glm::vec3(1, 2, 3)); // the only one with colors
    EXPECT_EQ(notices, 1u);
    EXPECT_EQ(first_pixel(channels, "View.Combined", notices), glm::vec3(1, 2, 3));
    EXPECT_EQ(notices, 0u);
}

TEST(ImageCorpus, KritaLayersExr) {
    const Channels channels = {{"sky.R", 1}, {"sky.G", 2}, {"sky.B", 3},
                               {"sun.R", 4}, {"sun.G", 5}, {"sun.B", 6}};
    std::size_t notices = 0;
    EXPECT_EQ(first_pixel(channels, "sun", notices), glm::vec3(4, 5, 6));
    EXPECT_NE(refusal_of(channels, "").find("'sky', 'sun'; choose one with --layer NAME"), std::string::npos)
        << refusal_of(channels, "");
    EXPECT_NE(refusal_of(channels, "moon").find("'sky', 'sun'"), std::string::npos);
}

TEST(ImageCorpus, LowerCaseChannelsExr) {
    std::size_t notices = 0;
    EXPECT_EQ(first_pixel({{"r", 1}, {"g", 2}, {"b", 3}}, "", notices), glm::vec3(1, 2, 3));
}

TEST(ImageCorpus, RenderedRegionOfASkyExr) {
    const test::TemporaryFolder folder;
    // Columns 1 and 2 of row 1 are there; the picture is 4 x 2.
    write_part(folder / "a.exr", kWindow, {{1, 1}, {2, 1}}, {{"R", 5}, {"G", 5}, {"B", 5}});
    const EnvironmentFile file = load_environment(folder / "a.exr");
    const Image& image = file.environment.image;
    ASSERT_EQ(image.width, kWidth);
    ASSERT_EQ(image.height, kHeight);
    for (int i = 0; i < kWidth * kHeight; ++i)
        EXPECT_EQ(image.pixels[static_cast<std::size_t>(i)], glm::vec3(i == 5 || i == 6 ? 5 : 0)) << i;
    EXPECT_EQ(file.notices.size(), 1u);
}

TEST(ImageCorpus, OverscanOfASkyExr) {
    const test::TemporaryFolder folder;
    write_part(folder / "a.exr", kWindow, {{-1, -1}, {kWidth, kHeight}}, {{"R", 5}, {"G", 5}, {"B", 5}});
    const Image image = load_environment(folder / "a.exr").environment.image;
    ASSERT_EQ(image.width, kWidth);
    ASSERT_EQ(image.height, kHeight);
    EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), glm::vec3(5)), kWidth * kHeight);
}

TEST(ImageCorpus, NukeMultipartExr) {
    const test::TemporaryFolder folder;
    std::vector<Imf::Header> headers;
    for (const char* name : {"beauty", "sky"}) {
        headers.emplace_back(kWindow, kWindow);
        headers.back().setName(name);
        headers.back().setType(Imf::SCANLINEIMAGE);
        headers.back().channels().insert("R", Imf::Channel(Imf::FLOAT));
    }
    {
        Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            std::vector<float> values(kWidth * kHeight, static_cast<float>(part + 1));
            Imf::FrameBuffer buffer;
            buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), kWindow));
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(buffer);
            output.writePixels(kHeight);
        }
    }
    const EnvironmentFile first = load_environment(folder / "a.exr");
    EXPECT_EQ(first.environment.image.pixels[0], glm::vec3(1, 0, 0));
    ASSERT_EQ(first.notices.size(), 1u);
    EXPECT_NE(first.notices[0].find("'beauty', 'sky'"), std::string::npos) << first.notices[0];
    EXPECT_EQ(load_environment(folder / "a.exr", with_layer("sky")).environment.image.pixels[0],
              glm::vec3(2, 0, 0));
}

/// An image of cells of 2 x 2 pixels; `cells` are numbers of faces, -1: black.
EnvironmentFile read_cells(int width, const std::vector<int>& cells, float marked = 0,
                           std::optional<EnvironmentLayout> layout = {}) {
    const int height = static_cast<int>(cells.size()) / width;
    Image image{2 * width, 2 * height, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.pixels.emplace_back(
                static_cast<float>(1 + cells[static_cast<std::size_t>(y / 2 * width + x / 2)]));
    image.pixels[0].x = marked > 0 ? marked : image.pixels[0].x;
    const test::TemporaryFolder folder;
    write_exr(folder / "a.exr", image);
    return load_environment(folder / "a.exr", {.layout = layout});
}

TEST(ImageCorpus, CubeMapsAsCrossesAndRows) {
    const std::pair<int, std::vector<int>> kUnfolded[] = {{4, {-1, 2, -1, -1, 1, 4, 0, 5, -1, 3, -1, -1}},
                                                          {3, {-1, 2, -1, 1, 4, 0, -1, 3, -1, -1, 5, -1}},
                                                          {6, {0, 1, 2, 3, 4, 5}}};
    const glm::vec3 directions[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const auto& [width, cells] : kUnfolded) {
        const EnvironmentFile file = read_cells(width, cells);
        EXPECT_EQ(file.notices.size(), 1u);
        const EnvironmentFile named = read_cells(width, cells, 0, EnvironmentLayout::cube_faces);
        EXPECT_TRUE(named.notices.empty());
        EXPECT_EQ(named.environment.image.pixels, file.environment.image.pixels);
        for (int face = 0; face < 6; ++face)
            EXPECT_EQ(sample(file.environment, directions[face]), glm::vec3(static_cast<float>(1 + face)))
                << width << " " << face;
    }
    EXPECT_THROW(read_cells(4, kUnfolded[0].second, 7), Error); // a picture of 4:3
}

TEST(ImageCorpus, SixFilesOfACubeMap) {
    const char* const kNames[][6] = {{"posx", "negx", "posy", "negy", "posz", "negz"},
                                     {"right", "left", "top", "bottom", "front", "back"}};
    for (const auto& names : kNames) {
        const test::TemporaryFolder folder;
        for (int face = 0; face < 6; ++face)
            write_exr(folder / (std::string("sky_") + names[face] + ".exr"),
                      {2, 2, std::vector<glm::vec3>(4, glm::vec3(static_cast<float>(face)))});
        const Environment environment = load_environment(folder / "sky_{face}.exr").environment;
        EXPECT_EQ(sample(environment, {0, 0, -1}), glm::vec3(5)) << names[0];
        EXPECT_EQ(sample(environment, {0, 1, 0}), glm::vec3(2)) << names[0];
    }
}

TEST(ImageCorpus, GitLfsPointer) {
    try {
        read("a.hdr", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 3\n");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("git lfs pull"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace prt
