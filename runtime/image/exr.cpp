// OpenEXR files: checked, read to linear Rec. 709 whatever their primaries, and written.
#include "exr.h"

#include "image_limits.h"
#include "prt/image_file.h"
#include "prt/support/error.h"
#include "prt/support/file.h"
#include "prt/write_exr.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfTestFile.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfXdr.h>

#include <algorithm>
#include <exception>
#include <string>

namespace prt {
namespace {

constexpr int kLargestSide = 65536;

/// Rows to decode at once: about four million pixels, so that a header's claim costs no memory until it is
/// true.
int rows_per_strip(int width) {
    return std::clamp((1 << 22) / width, 1, 256);
}

void check_size(const Imath::Box2i& window) {
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1)
        throw Error("its data window is empty");
    if (width > kLargestSide || height > 6 * std::int64_t{kLargestSide} || width * height > kMostPixels)
        throw Error("its data window of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels is larger than this program reads");
}

/// A tile is decoded whole, so its size is memory, whatever the image's.
void check_tiles(const Imf::Header& header) {
    if (!header.hasTileDescription())
        return;
    const Imf::TileDescription& tile = header.tileDescription();
    if (std::uint64_t{tile.xSize} * tile.ySize > (std::uint64_t{1} << 24))
        throw Error("its tiles of " + std::to_string(tile.xSize) + " x " + std::to_string(tile.ySize) +
                    " pixels are larger than this program reads");
}

void insert_rgb(Imf::FrameBuffer& buffer, const Imf::ChannelList& channels, glm::vec3* base,
                const Imath::Box2i& strip) {
    const bool grey = !channels.findChannel("R") && !channels.findChannel("G") && !channels.findChannel("B");
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const char* name = grey ? "Y" : names[c];
        if (const Imf::Channel* channel = channels.findChannel(name);
            channel && (channel->xSampling != 1 || channel->ySampling != 1))
            throw Error(std::string("its channel ") + name + " is subsampled");
        if (grey && c > 0)
            continue;
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, &(*base)[c], strip, sizeof(glm::vec3),
                                             sizeof(glm::vec3) *
                                                 static_cast<std::size_t>(strip.max.x - strip.min.x + 1)));
    }
}

/// Decodes strip by strip. `read_strip` fills [rows][width] pixels for the given rows.
template <class ReadStrip>
Image read_in_strips(const Imath::Box2i& window, ReadStrip&& read_strip) {
    Image image;
    image.width = window.max.x - window.min.x + 1;
    const int height = window.max.y - window.min.y + 1;
    const auto width = static_cast<std::size_t>(image.width);
    const int rows = rows_per_strip(image.width);
    for (int y = 0; y < height; y += rows) {
        const int count = std::min(rows, height - y);
        image.pixels.resize(static_cast<std::size_t>(y + count) * width);
        const Imath::Box2i strip({window.min.x, window.min.y + y},
                                 {window.max.x, window.min.y + y + count - 1});
        read_strip(&image.pixels[static_cast<std::size_t>(y) * width], strip);
    }
    image.height = height;
    return image;
}

Image read_rgb(Imf::InputFile& file, const Imath::Box2i& window) {
    const Imf::ChannelList& channels = file.header().channels();
    const bool grey = channels.findChannel("Y") && !channels.findChannel("R");
    Image image = read_in_strips(window, [&](glm::vec3* pixels, const Imath::Box2i& strip) {
        Imf::FrameBuffer buffer;
        insert_rgb(buffer, channels, pixels, strip);
        file.setFrameBuffer(buffer);
        file.readPixels(strip.min.y, strip.max.y);
    });
    if (grey)
        for (glm::vec3& pixel : image.pixels)
            pixel = glm::vec3(pixel.x);
    return image;
}

Image read_luminance_chroma(const std::string& path, const Imath::Box2i& window) {
    Imf::RgbaInputFile file(path.c_str());
    std::vector<Imf::Rgba> row;
    return read_in_strips(window, [&](glm::vec3* pixels, const Imath::Box2i& strip) {
        const auto width = static_cast<std::size_t>(strip.max.x - strip.min.x + 1);
        row.resize(width * static_cast<std::size_t>(strip.max.y - strip.min.y + 1));
        const std::ptrdiff_t origin = strip.min.x + strip.min.y * static_cast<std::ptrdiff_t>(width);
        file.setFrameBuffer(row.data() - origin, 1, width);
        file.readPixels(strip.min.y, strip.max.y);
        for (const Imf::Rgba& pixel : row)
            *pixels++ = glm::vec3(float(pixel.r), float(pixel.g), float(pixel.b));
    });
}

void convert_primaries(Image& image, const Imf::Chromaticities& from) {
    const Imf::Chromaticities rec709;
    if (from == rec709)
        return;
    const Imath::M44f matrix = Imf::RGBtoXYZ(from, 1) * Imf::XYZtoRGB(rec709, 1);
    for (glm::vec3& pixel : image.pixels) {
        const Imath::V3f converted = Imath::V3f(pixel.r, pixel.g, pixel.b) * matrix;
        pixel = glm::vec3(converted.x, converted.y, converted.z);
    }
}

/// Checks the header by itself: opening the file builds tables of all the lines and tiles that it claims.
void check_header(const std::string& path) {
    Imf::StdIFStream stream(path.c_str());
    int magic = 0, version = 0;
    Imf::Xdr::read<Imf::StreamIO>(stream, magic);
    Imf::Xdr::read<Imf::StreamIO>(stream, version);
    Imf::Header header;
    header.readFrom(stream, version);
    check_size(header.dataWindow());
    check_tiles(header);
}

ExrFile read_exr_unnamed(const std::string& path) {
    check_header(path);
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    const Imf::ChannelList& channels = header.channels();
    ExrFile result;
    if (channels.findChannel("RY") || channels.findChannel("BY"))
        result.image = read_luminance_chroma(path, window);
    else if (channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B") ||
             channels.findChannel("Y"))
        result.image = read_rgb(file, window);
    else
        throw Error("it has none of the channels R, G, B and Y");
    if (Imf::hasChromaticities(header))
        convert_primaries(result.image, Imf::chromaticities(header));
    if (Imf::hasEnvmap(header)) {
        const int envmap = Imf::envmap(header);
        if (envmap != Imf::ENVMAP_LATLONG && envmap != Imf::ENVMAP_CUBE)
            throw Error("its attribute envmap has the unknown value " + std::to_string(envmap));
        result.layout = envmap == Imf::ENVMAP_CUBE ? EnvironmentLayout::cube : EnvironmentLayout::lat_long;
    }
    return result;
}

} // namespace

bool is_exr(const std::filesystem::path& path) {
    return Imf::isOpenExrFile(path.c_str());
}

ExrFile read_exr(const std::filesystem::path& path) {
    try {
        return read_exr_unnamed(path.string());
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    } catch (const std::exception& error) {
        throw Error(path.string() + ": is a damaged or unsupported EXR: " + one_line(error.what()));
    }
}

void write_exr(const OutputFile& output, const Image& image, std::optional<EnvironmentLayout> layout) {
    try {
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        if (layout == EnvironmentLayout::cube || layout == EnvironmentLayout::lat_long)
            Imf::addEnvmap(header,
                           *layout == EnvironmentLayout::cube ? Imf::ENVMAP_CUBE : Imf::ENVMAP_LATLONG);
        for (const char* name : {"R", "G", "B"})
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        Imf::FrameBuffer buffer;
        insert_rgb(buffer, header.channels(), const_cast<glm::vec3*>(image.pixels.data()),
                   header.dataWindow());
        Imf::OutputFile file(output.temporary_path().c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    } catch (const std::exception& error) {
        throw Error(output.path().string() + ": cannot be written: " + one_line(error.what()));
    }
}

void write_exr(const std::filesystem::path& path, const Image& image,
               std::optional<EnvironmentLayout> layout) {
    OutputFile output(path);
    write_exr(output, image, layout);
    output.commit();
}

} // namespace prt
