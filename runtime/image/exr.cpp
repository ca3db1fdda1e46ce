// Reads OpenEXR files: checks them first, then converts to linear Rec. 709 from any primaries.
#include "runtime/image/exr.h"

#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/printable.h"
#include "runtime/image/exr_header.h"
#include "runtime/image/exr_layers.h"
#include "runtime/image/exr_stream.h"
#include "runtime/image/image_limits.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Returns the second word of the file.
int version_of(std::span<const std::byte> file) {
    std::uint32_t version = 0;
    if (file.size() >= 2 * sizeof(version))
        std::memcpy(&version, &file[sizeof(version)], sizeof(version));
    return static_cast<int>(version);
}

/// Returns the number of rows to decode at once: about four million pixels, so that a false size in the
/// header allocates no memory.
int rows_per_strip(int width) {
    return std::clamp((1 << 22) / width, 1, 256);
}

/// Inserts R, G and B, or Y alone for all of them.
void insert_rgb(Imf::FrameBuffer& buffer, const Imf::ChannelList& channels, const ExrLayer& layer,
                glm::vec3* base, const Imath::Box2i& strip) {
    const bool grey = !layer.grey.empty();
    for (int c = 0; c < (grey ? 1 : 3); ++c) {
        const std::string& name = grey ? layer.grey : layer.channels[static_cast<std::size_t>(c)];
        if (name.empty())
            continue; // remains zero
        if (const Imf::Channel* channel = channels.findChannel(name);
            channel && (channel->xSampling != 1 || channel->ySampling != 1))
            throw Error("its channel " + printable(name, 60) + " is subsampled, which is not supported");
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
    image.pixels.reserve(width * static_cast<std::size_t>(height)); // pages are committed when they are
                                                                    // written
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

/// Reads from an `Imf::InputFile` or an `Imf::InputPart`.
template <class File>
Image read_rgb(File& file, const ExrLayer& layer) {
    const Imf::ChannelList& channels = file.header().channels();
    Image image =
        read_in_strips(file.header().dataWindow(), [&](glm::vec3* pixels, const Imath::Box2i& strip) {
            Imf::FrameBuffer buffer;
            insert_rgb(buffer, channels, layer, pixels, strip);
            file.setFrameBuffer(buffer);
            file.readPixels(strip.min.y, strip.max.y);
        });
    if (!layer.grey.empty())
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

/// Places pixels that are a crop of a 2:1 picture, or extend beyond it, at their position in the picture; the
/// rest is black.
void position_in_display(ExrFile& file, const Imf::Header& header, std::size_t file_bytes) {
    const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
    const std::int64_t width = std::int64_t{display.max.x} - display.min.x + 1,
                       height = std::int64_t{display.max.y} - display.min.y + 1;
    Image& image = file.image;
    const bool cube = image.height == 6 * image.width || file.layout == EnvironmentLayout::cube;
    if (cube || width != 2 * height || height < 1 || (width == image.width && height == image.height))
        return;
    check_image_size(width, height, 2 * sizeof(glm::vec3), file_bytes);
    Image placed{static_cast<int>(width), static_cast<int>(height), {}};
    placed.pixels.resize(static_cast<std::size_t>(width * height));
    const int left = std::max(data.min.x, display.min.x), right = std::min(data.max.x, display.max.x);
    for (int y = std::max(data.min.y, display.min.y);
         y <= std::min(data.max.y, display.max.y) && left <= right; ++y) {
        const auto row = (std::int64_t{y} - data.min.y) * image.width + left - data.min.x,
                   to = (std::int64_t{y} - display.min.y) * width + left - display.min.x;
        std::copy_n(image.pixels.begin() + row, right - left + 1, placed.pixels.begin() + to);
    }
    file.notices.push_back("its " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                           " pixels are placed in the display window of " + std::to_string(width) + " x " +
                           std::to_string(height) + "; the remaining pixels are black");
    image = std::move(placed);
}

/// Applies the header's attributes to the pixels of `result`.
void apply_header(ExrFile& result, const Imf::Header& header, std::size_t file_bytes) {
    if (header.hasType() && Imf::isDeepData(header.type()))
        result.notices.emplace_back("is a deep EXR; the samples of each pixel are composited by depth");
    if (Imf::hasChromaticities(header))
        convert_primaries(result.image, Imf::chromaticities(header));
    if (Imf::hasEnvmap(header)) {
        const int envmap = Imf::envmap(header);
        if (envmap != Imf::ENVMAP_LATLONG && envmap != Imf::ENVMAP_CUBE)
            throw Error("its envmap attribute has the unknown value " + std::to_string(envmap));
        result.layout = envmap == Imf::ENVMAP_CUBE ? EnvironmentLayout::cube : EnvironmentLayout::lat_long;
    }
    position_in_display(result, header, file_bytes);
}

ExrFile read_parts(std::span<const std::byte> bytes, const std::string& wanted) {
    MemoryStream stream(bytes);
    Imf::MultiPartInputFile file(stream);
    std::vector<Imf::Header> headers;
    for (int part = 0; part < file.parts(); ++part)
        headers.push_back(file.header(part));
    ExrFile result;
    const ExrLayer layer = choose_layer(color_layers(headers), wanted, result.notices);
    Imf::InputPart part(file, layer.part);
    result.image = read_rgb(part, layer);
    apply_header(result, part.header(), bytes.size());
    return result;
}

ExrFile read_checked(std::span<const std::byte> bytes, const std::string& wanted) {
    if (Imf::isMultiPart(version_of(bytes)))
        return read_parts(bytes, wanted);
    MemoryStream stream(bytes);
    Imf::InputFile file(stream);
    const Imf::Header& header = file.header();
    const Imf::ChannelList& channels = header.channels();
    ExrFile result;
    const ExrLayer layer = choose_layer(color_layers({&header, 1}), wanted, result.notices);
    if (layer.plain && layer.grey == "Y" && (channels.findChannel("RY") || channels.findChannel("BY")))
        result.image = read_luminance_chroma(bytes, header.dataWindow());
    else
        result.image = read_rgb(file, layer);
    apply_header(result, header, bytes.size());
    return result;
}

} // namespace

bool is_exr(std::span<const std::byte> file) {
    return file.size() >= 4 && Imf::isImfMagic(reinterpret_cast<const char*>(file.data()));
}

ExrFile read_exr(std::span<const std::byte> file, const std::string& layer) {
    check_exr_header(file);
    try {
        return read_checked(file, layer);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(std::string("is a damaged or unsupported EXR: ") + printable(one_line(error.what())));
    }
}

} // namespace prt
