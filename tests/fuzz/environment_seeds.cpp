// Seeds: environment maps. OpenEXR of each compression and type, scanlines and tiles; Radiance HDR flat and
// run-length coded; PNG.
#include "seeds.h"

#include "prt/image/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <fstream>
#include <string>

namespace prt::fuzz {
namespace {

constexpr int kWidth = 16, kHeight = 8; // 8 is the minimum width for run-length encoding

void write_exr_seed(const Path& path, Imf::PixelType type, Imf::Compression compression, bool tiled) {
    Imf::Header header(kWidth, kHeight);
    header.compression() = compression;
    std::vector<char> pixels(4 * kWidth * kHeight, '\x01'); // small numbers of any type
    Imf::FrameBuffer buffer;
    const std::size_t size = type == Imf::HALF ? 2 : 4;
    for (const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(name, Imf::Slice(type, pixels.data(), size, size * kWidth));
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(8, 4, Imf::MIPMAP_LEVELS));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(kHeight);
    }
}

void write_luminance_chroma(const Path& path) {
    Imf::RgbaOutputFile file(path.c_str(), kWidth, kHeight, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> pixels(kWidth * kHeight, Imf::Rgba(0.5f, 0.25f, 1));
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
}

void write_hdr(const Path& path, const std::string& lines) {
    std::ofstream(path, std::ios::binary)
        << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << kHeight << " +X " << kWidth << "\n"
        << lines;
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i)
        all += text;
    return all;
}

} // namespace

void write_environment_seeds(const Path& folder) {
    const auto compressions = {Imf::NO_COMPRESSION,  Imf::RLE_COMPRESSION,  Imf::ZIPS_COMPRESSION,
                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,  Imf::PXR24_COMPRESSION,
                               Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION,
                               Imf::DWAB_COMPRESSION};
    for (const Imf::Compression compression : compressions)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
            for (const bool tiled : {false, true})
                write_exr_seed(
                    folder / "exr" /
                        (std::to_string(compression) + "_" + std::to_string(type) + (tiled ? "_tiles" : "")),
                    type, compression, tiled);
    write_luminance_chroma(folder / "exr" / "luminance_chroma");
    // A pixel is its mantissas and an exponent; 1, 1, 1, n repeats the one before it; a line may be runs.
    const std::string pixel("\x80\x40\x20\x81", 4), flat = repeated(pixel, kWidth);
    const std::string repeat = pixel + std::string({1, 1, 1, kWidth - 1});
    std::string runs({2, 2, 0, kWidth});
    for (const char value : pixel)
        runs += std::string({char(128 + kWidth), value});
    write_hdr(folder / "hdr" / "flat", repeated(flat, kHeight));
    write_hdr(folder / "hdr" / "repeat", repeated(repeat, kHeight));
    write_hdr(folder / "hdr" / "runs", repeated(runs, kHeight));
    const std::vector<glm::u8vec3> pixels(kWidth * kHeight, glm::u8vec3(9, 99, 199));
    write_png(folder / "pictures" / "png", kWidth, kHeight, pixels);
}

} // namespace prt::fuzz
