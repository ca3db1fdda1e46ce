#pragma once

// Reads environment maps (OpenEXR, Radiance HDR, PNG, JPEG) and textures (PNG, JPEG, WebP, AVIF), and writes
// OpenEXR and PNG. Stable.

#include "prt/core/environment.h"
#include "prt/core/glm_layout.h"

#include <glm/gtc/type_precision.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Returns the sRGB value of a linear value. Both are 0..1 (1 is white, not 255); values outside are not
/// clamped.
float srgb_encode(float linear);
/// Returns the linear value of an sRGB value. Both are 0..1 (1 is white, not 255); values outside are not
/// clamped.
float srgb_decode(float encoded);

/// Settings for reading an environment map.
struct EnvironmentOptions {
    /// Layout of the image; replaces the layout that the file specifies. Without a value: `cube_faces` for
    /// six files; else the EXR attribute `envmap`; else the shape: a cross or a row of cube faces is
    /// `cube_faces`, 2:1 is `lat_long`, 1:6 is `cube`. For `cube_faces`, faces in a cross or a row are moved
    /// into a column.
    std::optional<EnvironmentLayout> layout;
    /// Treatment of pixels with a NaN, infinite or negative component. Default: throw `Error`.
    BadPixels bad_pixels = BadPixels::error;
    /// Direction of the center column of a lat-long image. Files do not store it; other layouts ignore it.
    LatLongCenter center = LatLongCenter::z;
    /// Name of the layer or part of an OpenEXR file to read. Empty: the channels without a prefix, or the
    /// only layer. A name is an error for other formats.
    std::string layer = {};
};

/// An environment map as read from a file.
struct EnvironmentFile {
    Environment environment;         ///< linear Rec. 709, with layout and center as in `EnvironmentOptions`
    std::size_t repaired_pixels = 0; ///< number of pixels that `EnvironmentOptions::bad_pixels` changed
    /// True if the file (or a file of a cube face) is a PNG or JPEG: no value exceeds 1, and bright lights
    /// are clipped.
    bool low_dynamic_range = false;
    std::vector<std::string> notices; ///< messages for the user about how the file was read, one line each
};

/// Reads an environment map as linear Rec. 709. Formats: OpenEXR (any channel type and compression, scanline
/// or tiled, RGB, luminance or luminance-chroma; other primaries are converted; a crop of a 2:1 display
/// window is inserted into that window, the rest is black); Radiance HDR (RGBE or XYZE, any orientation;
/// EXPOSURE and COLORCORR are divided out); PNG and JPEG, which are read as sRGB. A path that contains
/// "{face}" describes six files, the faces of a cube, which are joined to a column in the sequence +X -X +Y
/// -Y +Z -Z; "{face}" is replaced by px, nx, py, ny, pz and nz (or PX .., posx .., +x .., or right, left,
/// top, bottom, front, back). Throws `Error` with the file name for a file that is missing, damaged or not an
/// environment map, for an image whose layout is unknown or does not fit its size, for an unknown or
/// ambiguous layer, and for bad pixels under `BadPixels::error`. An image has at most 2^28 pixels, and its
/// memory is limited to 192 MB plus 64 bytes per byte of the file; a larger image is an error.
EnvironmentFile load_environment(const std::filesystem::path& path, const EnvironmentOptions& options = {});

/// 8-bit RGBA pixels as stored in the file, without color conversion (usually sRGB). Alpha is 255 if the file
/// has none.
struct Image8 {
    int width = 0, height = 0;
    std::vector<glm::u8vec4> pixels; ///< [height][width], rows from the top
};

/// Decodes a PNG, JPEG, WebP or AVIF file in memory; 16-bit values are reduced to 8 bits. Throws `Error`
/// without a file name if it is damaged, has another format or is too large (see `load_environment`).
Image8 decode_image(std::span<const std::byte> file);

/// Returns an 8-bit RGB PNG file in memory. `pixels` is [height][width], rows from the top, stored without
/// color conversion; width and height are at least 1, which is not checked. Throws `Error` if memory runs
/// out.
std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec3> pixels);
/// Returns an 8-bit RGBA PNG file in memory. `pixels` is [height][width], rows from the top, stored without
/// color conversion; width and height are at least 1, which is not checked. Throws `Error` if memory runs
/// out.
std::vector<std::byte> encode_png(int width, int height, std::span<const glm::u8vec4> pixels);

/// Writes the result of `encode_png` to `path`. Throws the errors of `encode_png`, and `Error` if the file
/// cannot be written.
void write_png(const std::filesystem::path& path, int width, int height, std::span<const glm::u8vec3> pixels);

/// Returns an OpenEXR file in memory: 32-bit float RGB, ZIP-compressed. If `layout` is `lat_long` or `cube`,
/// the file has the attribute `envmap` with this layout; for other layouts, or without a value, it has no
/// such attribute. Does not check the number of pixels. Throws `Error` if the image cannot be encoded.
std::vector<std::byte> encode_exr(const Image& image, std::optional<EnvironmentLayout> layout = std::nullopt);

/// Writes the result of `encode_exr` to `path`. Throws `Error` if the image cannot be encoded or the file
/// cannot be written.
void write_exr(const std::filesystem::path& path, const Image& image,
               std::optional<EnvironmentLayout> layout = std::nullopt);

} // namespace prt
