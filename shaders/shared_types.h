// Names by which C++ compiles the shared headers as GLSL does: in C++ the types and functions of GLSL, in
// single precision in prt::glsl and in double precision in prt::glsl_double; and specifiers of functions.
#ifndef PRT_SHARED_TYPES_H
#define PRT_SHARED_TYPES_H

#ifdef __cplusplus

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>

#define PRT_FUNCTION [[gnu::always_inline]] constexpr
#define PRT_LAMP_FUNCTION inline

namespace prt::glsl {
using uint = std::uint32_t;
using glm::mat4, glm::vec2, glm::vec3, glm::vec4, glm::uvec2;
} // namespace prt::glsl

namespace prt::glsl_double {
using real = double;
using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using glm::abs, glm::atan, glm::ceil, glm::clamp, glm::cos, glm::cross, glm::dot, glm::length, glm::max, glm::min,
    glm::normalize, glm::sin, glm::sqrt;
} // namespace prt::glsl_double

#else

#define PRT_FUNCTION
#define PRT_LAMP_FUNCTION
#define real float

#endif

#endif
