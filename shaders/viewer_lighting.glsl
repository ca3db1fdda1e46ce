// What viewer_surface.vert hands to a fragment shader: the surface's normal and occlusion where it has them, and suns.

#include "surface.glsl"
#ifdef PRT_SUNS
#include "sun_light.glsl"
#endif

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

// Suns apart from the sky, on a surface of that base color.
vec3 light_of_suns(vec3 base) {
#ifdef PRT_SUNS
    return sun_radiance(base);
#else
    return vec3(0.0);
#endif
}
