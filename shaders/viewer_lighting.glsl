// Inputs of fragment shaders from viewer_surface.vert: normal and occlusion of the surface if it has them,
// its emission, and suns.

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
uniform bool occluded; // by the ambient occlusion of vertices

vec3 facing_normal() {
    return normalize(gl_FrontFacing ? normal : -normal);
}

float occlusion() {
    return occluded ? clamp(ao, 0.0, 1.0) : 1.0;
}
#endif

// Light that does not depend on how the sky is represented: separate suns on a surface of this base color,
// and its emission.
vec3 light_beside_the_sky(vec3 base) {
#ifdef PRT_SUNS
    return sun_radiance(base) + emitted_radiance();
#else
    return emitted_radiance();
#endif
}
