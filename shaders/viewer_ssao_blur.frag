// Averages the 4 x 4 occlusion values around a pixel that belong to the same surface.

#include "viewer_gbuffer.glsl"

layout(binding = PRT_UNIT_SSAO) uniform sampler2D ssao;
uniform mat4 inverse_view_projection;
uniform vec3 eye, forward;
uniform float radius;

out float result;

float distance_at(ivec2 pixel) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(textureSize(gbuffer_depth, 0));
    vec4 p = inverse_view_projection * vec4(vec3(uv, texelFetch(gbuffer_depth, pixel, 0).r) * 2.0 - 1.0, 1.0);
    return dot(p.xyz / p.w - eye, forward);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(ssao, 0) - 1;
    float here = distance_at(pixel), sum = 0.0, count = 0.0;
    for (int y = -2; y < 2; ++y)
        for (int x = -2; x < 2; ++x) {
            ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
            float near = abs(distance_at(other) - here) < radius ? 1.0 : 0.0;
            sum += near * texelFetch(ssao, other, 0).r;
            count += near;
        }
    result = count > 0.0 ? sum / count : texelFetch(ssao, pixel, 0).r;
}
