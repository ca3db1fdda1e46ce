// What every kernel of the baker begins with: what it shares with C++, and constants that are told when it is compiled
// by the device.

#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef PRT_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif

#include "shared_bake.h"
#include "shared_structs.h"

layout(constant_id = PRT_CONSTANT_ALPHA) const bool kAlpha = false;       // some surfaces do not stop all light
layout(constant_id = PRT_CONSTANT_TEXTURED) const bool kTextured = false; // textures ask what area a ray stands for
