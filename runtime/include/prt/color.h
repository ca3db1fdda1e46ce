#pragma once

// Luminance and greyness of colors. Experimental.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// Luminance weights of linear Rec. 709 red, green and blue; their sum is 1.
inline constexpr glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722);

/// Returns the luminance of a linear Rec. 709 color, in the unit of the color: the luminance of (v, v, v) is
/// v.
template <class Real>
Real luminance(const glm::vec<3, Real>& rgb) {
    return glm::dot(rgb, glm::vec<3, Real>(kLuminance));
}

/// Returns whether red, green and blue are exactly equal.
inline bool is_grey(const glm::vec3& rgb) {
    return rgb.r == rgb.g && rgb.g == rgb.b;
}

} // namespace prt
