#pragma once

// PNG, JPEG and Radiance HDR by stb.

#include "prt/core/environment.h"
#include "prt/image/image_file.h"
#include "runtime/image/image_size.h"

#include <cstddef>
#include <span>

namespace prt {

/// Radiance HDR, with the multipliers of its header divided out.
struct RadianceImage {
    Image image;
    glm::dvec3 factor; ///< product of these multipliers
};

/// Reads RGBE or XYZE in any orientation as linear Rec. 709. Throws `Error`.
RadianceImage decode_hdr(std::span<const std::byte> file);

/// Returns the size of a PNG, JPEG or Radiance HDR. Throws `Error`.
ImageSize size_by_stb(std::span<const std::byte> file);

/// Decodes a PNG or JPEG. Throws `Error`.
Image8 decode_by_stb(std::span<const std::byte> file);

} // namespace prt
