#pragma once

// Compile-time checks of the size, alignment and member order of GLM's types in each program that includes
// prtkit's headers. With other GLM settings the program would link, but read memory with the wrong layout.
// Stable.

#include <glm/ext/quaternion_double.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>

namespace prt {

#define PRT_GLM                                                                                              \
    "prtkit uses GLM's packed types: do not define GLM_FORCE_DEFAULT_ALIGNED_GENTYPES, see "                 \
    "docs/integration.md"
static_assert(sizeof(glm::vec2) == 2 * sizeof(float) && sizeof(glm::vec3) == 3 * sizeof(float) &&
                  sizeof(glm::vec4) == 4 * sizeof(float) && sizeof(glm::uvec3) == 3 * sizeof(unsigned) &&
                  sizeof(glm::dvec3) == 3 * sizeof(double) && sizeof(glm::dmat3) == 9 * sizeof(double),
              PRT_GLM);
static_assert(alignof(glm::vec3) == alignof(float) && alignof(glm::vec4) == alignof(float) &&
                  alignof(glm::dvec3) == alignof(double),
              PRT_GLM);
static_assert(offsetof(glm::dquat, w) == 3 * sizeof(double),
              "prtkit uses quaternions with w last: do not define GLM_FORCE_QUAT_DATA_WXYZ");
#undef PRT_GLM

} // namespace prt
