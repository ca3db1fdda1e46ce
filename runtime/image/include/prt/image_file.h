#pragma once

// Reads environment maps (OpenEXR, Radiance HDR, PNG, JPEG) and textures (PNG, JPEG), and writes OpenEXR and
// PNG. Stable.

#include "prt/environment.h"
#include "prt/support/glm_layout.h"

#include <glm/gtc/type_precision.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Settings for reading an environment map.
struct EnvironmentOptions {
    /// Layout of an image whose file does not specify it (EXR attribute `envmap`). Without a value it follows
    /// from the aspect ratio, 2:1 or 1:6.
    std::optional<EnvironmentLayout> layout;
    BadPixels bad_pixels = BadPixels::error;
    LatLongCenter center = LatLongCenter::z; ///< not stored in files
    /// Layer or part of an OpenEXR file. Empty: the channels without a prefix, or the only layer.
    std::string layer = {};
};

/// An environment map as read from a file.
struct EnvironmentFile {
    Environment environment;
    std::size_t repaired_pixels = 0;
    /// True if the file is a PNG or JPEG, read as sRGB: no value exceeds 1, and bright lights are
    /// clipped.
    bool low_dynamic_range = false;
    std::vector<std::string> notices; ///< messages for the user about how the file was read, one line each
};

/// Reads an environment map from OpenEXR (any channel type and compression, scanline or tiled, RGB, luminance
/// or luminance-chroma; other primaries are converted; a crop of a 2:1 display window is inserted into that
/// window), Radiance HDR (RGBE or XYZE, any orientation, EXPOSURE and COLORCORR divided out), or PNG and
/// JPEG, which are read as sRGB. A path that contains "{face}" stands for six files with the layout
/// `EnvironmentLayout::cube_faces`; "{face}" is replaced by px, nx, py, ny, pz and nz (or posx .., +x ..,
/// right, left, top, bottom, front, back). Throws `Error` with the file name for a file that is damaged or
/// not an environment map. The memory for the image is limited to 192 MB plus 64 bytes per byte of the file.
EnvironmentFile load_environment(const std::filesystem::path& path, const EnvironmentOptions& options = {});

/// 8-bit RGBA pixels as stored, without color conversion.
struct Image8 {
    int width = 0, height = 0;
    std::vector<glm::u8vec4> pixels; ///< [height][width]
};

/// Decodes a PNG or JPEG file in memory. Throws `Error` if it is damaged, has another format or is too large.
Image8 decode_image(std::span<const std::byte> file);

/// Returns an 8-bit RGB PNG in memory. `pixels` is [height][width].
std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec3> pixels);
/// Returns an 8-bit RGBA PNG in memory. `pixels` is [height][width].
std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec4> pixels);

/// Writes an 8-bit RGB PNG. `pixels` is [height][width].
void write_png(const std::filesystem::path& path, int width, int height, std::span<const glm::u8vec3> pixels);

/// Returns an OpenEXR file in memory: 32-bit float RGB, ZIP-compressed, marked as an environment map if
/// `layout` is one of OpenEXR's two layouts.
std::vector<std::byte> encode_exr(const Image& image, std::optional<EnvironmentLayout> layout = std::nullopt);

/// Writes the file of `encode_exr`.
void write_exr(const std::filesystem::path& path, const Image& image,
               std::optional<EnvironmentLayout> layout = std::nullopt);

} // namespace prt
