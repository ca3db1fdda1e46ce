#pragma once

// How large an image says it is. Experimental.

#include <cstddef>
#include <span>

namespace prt {

struct ImageSize {
    int width = 0, height = 0;
};

/// What a PNG, JPEG or Radiance HDR file in memory says of its size. Throws `Error` when it is something
/// else.
ImageSize image_size(std::span<const std::byte> file);

} // namespace prt
