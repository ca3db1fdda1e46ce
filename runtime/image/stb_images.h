#pragma once

// PNG, JPEG and Radiance HDR by stb.

#include "prt/environment.h"
#include "prt/image_file.h"
#include "prt/image_size.h"

#include <cstddef>
#include <span>

namespace prt {

/// The pixels of a Radiance HDR. Throws `Error`.
Image decode_hdr(std::span<const std::byte> file);

/// Of a PNG, JPEG or Radiance HDR. Throws `Error`.
ImageSize size_by_stb(std::span<const std::byte> file);

/// The pixels of a PNG or JPEG. Throws `Error`.
Image8 decode_by_stb(std::span<const std::byte> file);

} // namespace prt
