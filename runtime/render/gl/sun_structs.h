#pragma once

// The structs of shaders/shared_suns.h in C++ with the types of GLSL; checks that their memory layout is
// std430.

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstddef>

namespace prt::suns {

using glm::vec2, glm::vec4;

#include "shared_suns.h"

static_assert(sizeof(SunLight) == 32 && sizeof(SunMap) == 64 && offsetof(SunMap, texels_per_metre) == 48 &&
              offsetof(SunMap, depth) == 56);
static_assert(offsetof(SunsSeen, maps) == 32 * PRT_MAX_SUNS &&
              offsetof(SunsSeen, slice_ends) == (32 + 64 * PRT_MAX_SLICES) * PRT_MAX_SUNS &&
              offsetof(SunsSeen, count) == offsetof(SunsSeen, slice_ends) + 48 &&
              sizeof(SunsSeen) == offsetof(SunsSeen, count) + 16);

} // namespace prt::suns
