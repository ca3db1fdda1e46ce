// Exit radiance times base color, linear. Define PRT_SUNS to add the light of suns with shadow maps.

#include "surface.glsl"
#include "emission.glsl"
#ifdef PRT_SUNS
#include "sun_light.glsl"
#endif

#ifdef PRT_LIGHTMAP
#include "lightmap.glsl"
#else
in vec3 radiance;

vec3 given_radiance() {
    return radiance;
}
#endif

out vec4 result;

void main() {
    vec4 base = surface_base_color();
    vec3 lit = max(given_radiance(), vec3(0.0)) * base.rgb;
#ifdef PRT_SUNS
    lit += sun_radiance(base.rgb);
#endif
    result = vec4(lit + emitted_radiance(), base.a);
}
