// Writes OpenEXR files, in memory first, because the library's own streams do not report when the last bytes
// are lost.
#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "runtime/image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace prt {
namespace {

/// Output buffer that grows on write. OpenEXR seeks back to fill in the table of lines.
class GrowingStream : public Imf::OStream {
public:
    GrowingStream() : Imf::OStream("EXR") {}

    void write(const char from[], int count) override {
        const auto bytes = std::as_bytes(std::span(from, static_cast<std::size_t>(count)));
        file.resize(std::max(file.size(), position_ + bytes.size()));
        std::ranges::copy(bytes, file.begin() + static_cast<std::ptrdiff_t>(position_));
        position_ += bytes.size();
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<std::byte> file;

private:
    std::size_t position_ = 0;
};

Imf::Header header_of(const Image& image, std::optional<EnvironmentLayout> layout) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (layout == EnvironmentLayout::cube || layout == EnvironmentLayout::lat_long)
        Imf::addEnvmap(header, *layout == EnvironmentLayout::cube ? Imf::ENVMAP_CUBE : Imf::ENVMAP_LATLONG);
    for (const char* name : {"R", "G", "B"})
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    return header;
}

Imf::FrameBuffer frame_of(const Image& image) {
    auto* pixels = reinterpret_cast<char*>(const_cast<glm::vec3*>(image.pixels.data())); // read-only use
    Imf::FrameBuffer frame;
    for (const auto& [name, offset] : {std::pair("R", 0u), {"G", 1u}, {"B", 2u}})
        frame.insert(name, Imf::Slice(Imf::FLOAT, pixels + offset * sizeof(float), sizeof(glm::vec3),
                                      sizeof(glm::vec3) * static_cast<std::size_t>(image.width)));
    return frame;
}

} // namespace

std::vector<std::byte> encode_exr(const Image& image, std::optional<EnvironmentLayout> layout) {
    GrowingStream stream;
    try {
        {
            Imf::OutputFile file(stream, header_of(image, layout));
            file.setFrameBuffer(frame_of(image));
            file.writePixels(image.height);
        }
        // When memory runs out, the library omits lines without an error.
        MemoryStream written(stream.file);
        if (!Imf::InputFile(written).isComplete())
            throw std::bad_alloc();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error("the image could not be encoded: " + one_line(error.what()));
    }
    return std::move(stream.file);
}

void write_exr(const std::filesystem::path& path, const Image& image,
               std::optional<EnvironmentLayout> layout) {
    OutputFile output(path);
    output.write(encode_exr(image, layout));
    output.commit();
}

} // namespace prt
