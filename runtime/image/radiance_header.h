#pragma once

// The header of a Radiance picture (.hdr, .pic).

#include "prt/image_size.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// Size, order and scale of the pixels.
struct RadianceHeader {
    ImageSize size;                    ///< of the picture as it is seen
    bool columns = false;              ///< the file stores columns one after the other, not rows
    bool up = false, left = false;     ///< lines run from the bottom up, or from the right to the left
    bool xyz = false;                  ///< CIE XYZ instead of RGB
    glm::dvec3 factor = glm::dvec3(1); ///< product of all EXPOSURE and COLORCORR lines; 1: none
    std::size_t bytes = 0;             ///< of the header; the pixels follow

    /// Index of pixel `i` of line `line`, both in the order of the file, in a picture of rows from the top.
    std::size_t index(std::size_t line, std::size_t i) const;
    std::size_t lines() const { return static_cast<std::size_t>(columns ? size.width : size.height); }
    std::size_t line_length() const { return static_cast<std::size_t>(columns ? size.height : size.width); }
};

/// Throws `Error` where the header is damaged or names a format of pixels that is not Radiance's.
RadianceHeader read_radiance_header(std::span<const std::byte> file);

} // namespace prt
