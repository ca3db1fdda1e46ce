#pragma once

// C++ version of shaders/shared_lamps.h in double precision.

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace prt::lamp_geometry {

using real = double;
using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using glm::abs, glm::atan, glm::ceil, glm::clamp, glm::cos, glm::cross, glm::dot, glm::length, glm::max,
    glm::min, glm::normalize, glm::sin, glm::sqrt;

#include "shared_lamps.h"

} // namespace prt::lamp_geometry
