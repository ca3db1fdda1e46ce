#pragma once

// Reads the size of an image from its header, without decoding pixels. Experimental.

#include <cstddef>
#include <span>

namespace prt {

/// Size of an image in pixels.
struct ImageSize {
    int width = 0, height = 0;
};

/// Returns the size that the header of a file in memory specifies: PNG, JPEG, WebP, AVIF or Radiance HDR.
/// Throws `Error` for other formats, OpenEXR included, for a damaged header, and for WebP and AVIF files that
/// `decode_image` (prt/image/image_file.h) rejects as animated WebP or as too large. The pixels may still be
/// damaged.
ImageSize image_size(std::span<const std::byte> file);

/// Returns whether the header of a file in memory is that of a PNG with the channels red, green, blue and
/// alpha, 8 bits each. `decode_image` (prt/image/image_file.h) then returns these bytes unchanged.
bool is_png_of_bytes(std::span<const std::byte> file);

} // namespace prt
