// Reads the G-buffer of viewer_gbuffer.frag.

#include "shared_viewer.h"

layout(binding = PRT_UNIT_GBUFFER_BASE) uniform sampler2D gbuffer_base;
layout(binding = PRT_UNIT_GBUFFER_NORMAL) uniform sampler2D gbuffer_normal;
layout(binding = PRT_UNIT_GBUFFER_RADIANCE) uniform sampler2D gbuffer_radiance;
layout(binding = PRT_UNIT_GBUFFER_DEPTH) uniform sampler2D gbuffer_depth;

vec3 gbuffer_normal_at(ivec2 pixel) {
    vec2 f = texelFetch(gbuffer_normal, pixel, 0).xy * 2.0 - 1.0;
    vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
    float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}
