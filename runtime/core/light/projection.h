#pragma once

// Projection of environments in double, per layout. Arguments must be valid.

#include "prt/core/environment.h"
#include "prt/core/sh_basis.h"

#include <glm/vec3.hpp>

#include <array>

namespace prt {

using ProjectedColors = std::array<glm::dvec3, kMaxOrder * kMaxOrder>;

/// Returns the number of quadrature points that a texel of `angle` radians needs along each axis. 24 points
/// integrate order 10 over half a sphere to rounding; over small texels 3 points have an error of order
/// angle^7, and 2 of order angle^5.
int points_for(double angle);

ProjectedColors project_cube(const Environment& environment, int order, int threads);
ProjectedColors project_angular(const Image& image, int order, int threads);

} // namespace prt
