// Light of a surface that the viewer's moving objects leave unblocked: relative to the light of the volume
// (PRT_VOLUME), or to a uniform environment.

#ifdef PRT_VOLUME
#include "prt_volume.glsl"
#endif
#include "prt_occluders.glsl"

in vec3 occluded_position, occluded_normal;
uniform vec3 occluders_low, occluders_high; // nothing is blocked outside

vec3 left_by_occluders() {
    vec3 inside = clamp(occluded_position, occluders_low, occluders_high), left = vec3(1.0);
    if (inside == occluded_position && occluded_normal != vec3(0.0)) {
        vec3 n = normalize(gl_FrontFacing ? occluded_normal : -occluded_normal);
#ifdef PRT_VOLUME
        vec3 light[PRT_VOLUME_COEFFICIENTS];
        prt_volume_incident(occluded_position, n, light);
        left = prt_occluders_light(occluded_position, n, light);
#else
        left = vec3(prt_occluders_visibility(occluded_position, n));
#endif
    }
    return left;
}
