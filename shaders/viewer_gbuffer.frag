// Writes a surface to the G-buffer: base color, with alpha of five bits of ambient occlusion and one bit that
// is set if the third target contains the exit radiance; otherwise the third target contains the light of
// separate suns and the emission of the surface. The normal is octahedral (Meyer et al. 2010).

#include "viewer_lighting.glsl"
#include "prt_dithered.glsl"
#include "shared_viewer.h"

layout(location = 0) out vec4 target_base;
layout(location = 1) out vec2 target_normal;
layout(location = 2) out vec4 target_radiance;

uniform bool dithered;

vec2 octahedral(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return (n.z >= 0.0 ? n.xy : folded) * 0.5 + 0.5;
}

void main() {
    vec4 base = surface_base_color();
#ifdef PRT_RADIANCE_GIVEN
    target_base = vec4(base.rgb, 1.0 / 255.0);
    target_normal = vec2(0.5);
    target_radiance =
        vec4(min(max(given_radiance(), vec3(0.0)) * base.rgb * left_by_occluders() + light_beside_the_sky(base.rgb),
                 vec3(65000.0)),
             1.0);
#else
    float threshold = dithered ? prt_bayer_threshold(uvec2(gl_FragCoord.xy)) : 0.5;
    float level = prt_dithered_level(occlusion(), float(PRT_AO_LEVELS), threshold);
    target_base = vec4(base.rgb, 8.0 * level / 255.0);
    target_normal = octahedral(facing_normal());
    target_radiance = vec4(min(light_beside_the_sky(base.rgb), vec3(65000.0)), 1.0);
#endif
}
