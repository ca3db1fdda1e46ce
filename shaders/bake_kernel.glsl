// Common beginning of all kernels of the baker: definitions shared with C++, and specialisation constants.

#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef PRT_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

#include "shared_bake.h"
#include "shared_structs.h"

layout(constant_id = PRT_CONSTANT_ALPHA) const bool kAlpha = false;       // some surfaces do not stop all light
layout(constant_id = PRT_CONSTANT_TEXTURED) const bool kTextured = false; // textures need the area that a ray
                                                                          // represents
