#pragma once

// How large an image says it is. Experimental.

#include <cstddef>
#include <span>

namespace prt {

struct ImageSize {
    int width = 0, height = 0;
};

/// What a PNG, JPEG, WebP, AVIF or Radiance HDR file in memory says of its size. Throws `Error` when it is
/// something else.
ImageSize image_size(std::span<const std::byte> file);

/// Whether a file in memory begins as a PNG does that has 8 bits in each of red, green, blue and alpha: bytes
/// that `decode_image` gives as they are.
bool is_png_of_bytes(std::span<const std::byte> file);

} // namespace prt
