#pragma once

// Size of an image from its header. Experimental.

#include <cstddef>
#include <span>

namespace prt {

/// Size of an image in pixels.
struct ImageSize {
    int width = 0, height = 0;
};

/// Returns the size in the header of a PNG, JPEG, WebP, AVIF or Radiance HDR file in memory. Throws `Error`
/// for other formats.
ImageSize image_size(std::span<const std::byte> file);

/// Returns whether a file in memory starts as a PNG with 8 bits each of red, green, blue and alpha;
/// `decode_image` returns its bytes unchanged.
bool is_png_of_bytes(std::span<const std::byte> file);

} // namespace prt
