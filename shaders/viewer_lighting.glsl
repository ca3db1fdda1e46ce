// What viewer_surface.vert hands to a fragment shader: the surface's normal and occlusion where it has them, what it
// gives off, and suns.

#include "surface.glsl"
#include "emission.glsl"
#ifdef PRT_SUNS
#include "sun_light.glsl"
#endif

#ifdef PRT_OCCLUDED
#include "viewer_occluders.glsl"
#else
vec3 left_by_occluders() {
    return vec3(1.0);
}
#endif

#if defined(PRT_LIGHTMAP)
#define PRT_RADIANCE_GIVEN
#include "lightmap.glsl"
#elif defined(PRT_COMPRESSED) || defined(PRT_VERTEX_RADIANCE)
#define PRT_RADIANCE_GIVEN
in vec3 radiance;

vec3 given_radiance() {
    return radiance;
}
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

// What is the same however the sky is shown: suns apart from it, on a surface of that base color, and what that gives
// off by itself.
vec3 light_beside_the_sky(vec3 base) {
#ifdef PRT_SUNS
    return sun_radiance(base) + emitted_radiance();
#else
    return emitted_radiance();
#endif
}
