// Lights the G-buffer.

#include "viewer_gbuffer.glsl"
#include "irradiance.glsl"

layout(binding = PRT_UNIT_SSAO) uniform sampler2D ssao;
uniform bool has_ssao;

out vec4 result;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(gbuffer_depth, pixel, 0).r == 1.0)
        discard;
    vec4 base = texelFetch(gbuffer_base, pixel, 0);
    uint bits = uint(round(base.a * 255.0));
    vec3 lit = texelFetch(gbuffer_radiance, pixel, 0).rgb;
    if ((bits & 1u) == 0u) {
        float occlusion = float(bits >> 3) / float(PRT_AO_LEVELS);
        if (has_ssao)
            occlusion *= texelFetch(ssao, pixel, 0).r;
        lit += base.rgb * unshadowed_radiance(gbuffer_normal_at(pixel)) * occlusion;
    }
    result = vec4(min(lit, vec3(65000.0)), 1.0);
}
