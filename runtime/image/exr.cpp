// Reads OpenEXR files: checked first, to linear Rec. 709 whatever their primaries.
#include "exr.h"

#include "exr_header.h"
#include "exr_stream.h"
#include "prt/image_file.h"
#include "prt/support/error.h"
#include "prt/support/printable.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <exception>
#include <string>

namespace prt {
namespace {

/// Rows to decode at once: about four million pixels, so that a header's claim costs no memory until it is
/// true.
int rows_per_strip(int width) {
    return std::clamp((1 << 22) / width, 1, 256);
}

bool has_rgb(const Imf::ChannelList& channels) {
    return channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
}

/// R, G and B, or Y alone for all of them.
void insert_rgb(Imf::FrameBuffer& buffer, const Imf::ChannelList& channels, glm::vec3* base,
                const Imath::Box2i& strip) {
    const bool grey = !has_rgb(channels);
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
    image.pixels.reserve(width * static_cast<std::size_t>(height)); // its pages are taken as they are written
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
    Image image = read_in_strips(window, [&](glm::vec3* pixels, const Imath::Box2i& strip) {
        Imf::FrameBuffer buffer;
        insert_rgb(buffer, channels, pixels, strip);
        file.setFrameBuffer(buffer);
        file.readPixels(strip.min.y, strip.max.y);
    });
    if (!has_rgb(channels))
        for (glm::vec3& pixel : image.pixels)
            pixel = glm::vec3(pixel.x);
    return image;
}

Image read_luminance_chroma(std::span<const std::byte> bytes, const Imath::Box2i& window) {
    MemoryStream stream(bytes);
    Imf::RgbaInputFile file(stream);
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

ExrFile read_checked(std::span<const std::byte> bytes) {
    MemoryStream stream(bytes);
    Imf::InputFile file(stream);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    const Imf::ChannelList& channels = header.channels();
    ExrFile result;
    if (!has_rgb(channels) && !channels.findChannel("Y"))
        throw Error("it has none of the channels R, G, B and Y");
    if (!has_rgb(channels) && (channels.findChannel("RY") || channels.findChannel("BY")))
        result.image = read_luminance_chroma(bytes, window);
    else
        result.image = read_rgb(file, window);
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

bool is_exr(std::span<const std::byte> file) {
    return file.size() >= 4 && Imf::isImfMagic(reinterpret_cast<const char*>(file.data()));
}

ExrFile read_exr(std::span<const std::byte> file) {
    check_exr_header(file);
    try {
        return read_checked(file);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(std::string("is a damaged or unsupported EXR: ") + printable(one_line(error.what())));
    }
}

} // namespace prt
