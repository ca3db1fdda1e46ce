// Lights a surface in one pass. Alpha is 1 on surfaces.

#include "viewer_lighting.glsl"
#include "irradiance.glsl"

out vec4 result;

void main() {
    vec4 base = surface_base_color();
#ifdef PRT_RADIANCE_GIVEN
    vec3 lit = max(given_radiance(), vec3(0.0)) * base.rgb * left_by_occluders();
#else
    vec3 lit = unshadowed_radiance(facing_normal()) * occlusion() * base.rgb;
#endif
    result = vec4(min(lit + light_beside_the_sky(base.rgb), vec3(65000.0)), base.a);
}
