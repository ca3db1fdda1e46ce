#pragma once

// PNG, JPEG and Radiance HDR by stb.

#include "prt/environment.h"

#include <cstddef>
#include <span>

namespace prt {

/// The pixels of a Radiance HDR. Throws `Error`.
Image decode_hdr(std::span<const std::byte> file);

} // namespace prt
