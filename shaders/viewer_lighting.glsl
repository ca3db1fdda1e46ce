// What viewer_surface.vert hands to a fragment shader, and the surface's normal and occlusion where it has them.

#include "surface.glsl"

#if defined(PRT_COMPRESSED) || defined(PRT_VERTEX_RADIANCE)
#define PRT_RADIANCE_GIVEN
in vec3 radiance;
#else
in vec3 normal;
in float ao;
uniform bool occluded; // by the vertices' ambient occlusion

vec3 facing_normal() {
    return normalize(gl_FrontFacing ? normal : -normal);
}

float occlusion() {
    return occluded ? clamp(ao, 0.0, 1.0) : 1.0;
}
#endif
