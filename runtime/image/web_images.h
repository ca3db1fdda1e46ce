#pragma once

// WebP and AVIF by libwebp and libavif.

#include "prt/image/image_file.h"
#include "runtime/image/image_size.h"

#include <cstddef>
#include <span>

namespace prt {

/// Returns the size of a WebP image. Throws `Error` for damaged files, for animations, and for sizes beyond
/// the limits of image_limits.h.
ImageSize webp_size(std::span<const std::byte> file);
/// Decodes a WebP image. Throws the errors of `webp_size`.
Image8 decode_webp(std::span<const std::byte> file);

/// Returns the size of an AVIF image, or of the first image of a sequence. Throws `Error` for damaged files,
/// and for sizes beyond the limits of image_limits.h.
ImageSize avif_size(std::span<const std::byte> file);
/// Decodes an AVIF image, or the first image of a sequence; 10 and 12 bits are rounded to 8. Throws the
/// errors of `avif_size`.
Image8 decode_avif(std::span<const std::byte> file);

} // namespace prt
