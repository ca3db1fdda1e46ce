#pragma once

// Computes the light that one large triangle reflects onto a small receiver below it, by the baker and by an
// independent quadrature.

#include "prt/core/baked_transfer.h"

#include <array>
#include <iosfwd>

namespace prt::test {

/// The quantity that varies over the triangle.
enum class Varying {
    light,             ///< reflectance belongs to the corners
    vertex_colors,     ///< and light
    texture,           ///< and light
    light_on_the_back, ///< a sheet of two sides, seen from behind
    vertex_colors_of_the_back,
};
inline constexpr std::array kAllVarying = {Varying::light, Varying::vertex_colors, Varying::texture,
                                           Varying::light_on_the_back, Varying::vertex_colors_of_the_back};
std::ostream& operator<<(std::ostream& out, Varying varying);

/// Largest difference from the quadrature over all coefficients, as a share of the largest of them.
struct BounceError {
    double baked;   ///< error of the baker
    double swapped; ///< minimum error of the quadrature with any two corners of the triangle exchanged
};
BounceError bounce_off_triangle(Varying varying, Backend backend);

} // namespace prt::test
