#pragma once

// Coefficients of an environment in double, layout by layout. Shapes have been checked.

#include "prt/environment.h"
#include "prt/sh_basis.h"

#include <glm/vec3.hpp>

#include <array>

namespace prt {

using ProjectedColors = std::array<glm::dvec3, kMaxOrder * kMaxOrder>;

/// How many quadrature points a texel that spans `angle` radians needs along each axis: over half a sphere 24
/// points integrate order 10 to rounding, over small texels 3 leave an error of order angle^7, 2 of angle^5.
int points_for(double angle);

ProjectedColors project_cube(const Environment& environment, int order, int threads);
ProjectedColors project_angular(const Image& image, int order, int threads);

} // namespace prt
