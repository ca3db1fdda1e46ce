// Position and normal of a vertex in the scene: those of the mesh, or if PRT_INSTANCED transformed by the
// matrix of the instance, which rotates, translates and scales uniformly.

#include "shared_layout.h"

#ifdef PRT_INSTANCED
layout(location = PRT_LOCATION_INSTANCE_X) in vec4 world_x; // rows of the matrix
layout(location = PRT_LOCATION_INSTANCE_Y) in vec4 world_y;
layout(location = PRT_LOCATION_INSTANCE_Z) in vec4 world_z;

vec3 position_in_scene(vec3 position) {
    vec4 point = vec4(position, 1.0);
    return vec3(dot(world_x, point), dot(world_y, point), dot(world_z, point));
}

vec3 normal_in_scene(vec3 normal) {
    return vec3(dot(world_x.xyz, normal), dot(world_y.xyz, normal), dot(world_z.xyz, normal)) *
           inversesqrt(dot(world_x.xyz, world_x.xyz));
}
#else
vec3 position_in_scene(vec3 position) {
    return position;
}

vec3 normal_in_scene(vec3 normal) {
    return normal;
}
#endif
