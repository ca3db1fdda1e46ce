#pragma once

// WebP and AVIF by libwebp and libavif.

#include "prt/image_file.h"
#include "prt/image_size.h"

#include <cstddef>
#include <span>

namespace prt {

/// Throw `Error` for damaged files, for animations, and for sizes beyond the limits of image_limits.h.
ImageSize webp_size(std::span<const std::byte> file);
Image8 decode_webp(std::span<const std::byte> file);

/// Read an AVIF, of a sequence the first image; 10 and 12 bits are rounded to 8. Throw `Error` for damaged
/// files, and for sizes beyond the limits of image_limits.h.
ImageSize avif_size(std::span<const std::byte> file);
Image8 decode_avif(std::span<const std::byte> file);

} // namespace prt
