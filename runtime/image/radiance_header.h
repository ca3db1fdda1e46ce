#pragma once

// The header of a Radiance picture (.hdr, .pic).

#include "runtime/image/image_size.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace prt {

/// Size, order and scale of the pixels.
struct RadianceHeader {
    ImageSize size;                    ///< size of the displayed picture
    bool columns = false;              ///< the file stores columns instead of rows
    bool up = false, left = false;     ///< lines run from bottom to top, or from right to left
    bool xyz = false;                  ///< CIE XYZ instead of RGB
    glm::dvec3 factor = glm::dvec3(1); ///< product of all EXPOSURE and COLORCORR lines; 1 without any
    std::size_t bytes = 0;             ///< size of the header; the pixels follow

    /// Returns the index of pixel `i` of line `line`, both in the order of the file, in a picture with rows
    /// from the top.
    std::size_t index(std::size_t line, std::size_t i) const;
    std::size_t lines() const { return static_cast<std::size_t>(columns ? size.width : size.height); }
    std::size_t line_length() const { return static_cast<std::size_t>(columns ? size.height : size.width); }
};

/// Parses a header. Throws `Error` if the header is damaged or names an unknown pixel format.
RadianceHeader read_radiance_header(std::span<const std::byte> file);

} // namespace prt
