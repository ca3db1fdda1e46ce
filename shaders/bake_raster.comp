// Receivers look up whether light from each direction of a batch of depth maps reaches them, and sum the
// spherical harmonics of the directions. With PRT_PEEL: computes the light that one layer of blended surfaces
// transmits, for the first direction.

#include "shared_bake.h"
#include "shared_structs.h"

#define PRT_COEFFICIENTS (PRT_ORDER * PRT_ORDER)

layout(local_size_x = 64) in;

layout(std430, binding = PRT_BINDING_RECEIVERS) readonly buffer Receivers {
    Receiver receivers[];
};
layout(std430, binding = PRT_BINDING_DIRECTIONS) readonly buffer Directions {
    Direction directions[];
};
layout(std430, binding = PRT_BINDING_SUMS) buffer Sums {
    float sums[]; // per receiver: all directions [order²], blocked directions [order²], weights of both
};
layout(std430, binding = PRT_BINDING_PASSES) buffer Passes {
    float passes[]; // per receiver: light that blended layers transmit
};
layout(binding = PRT_UNIT_OPAQUE_DEPTH) uniform sampler2DArray opaque_depth;
layout(binding = PRT_UNIT_LAST_DEPTH) uniform sampler2D layer_depth;
layout(binding = PRT_UNIT_LAYER_COVERAGE) uniform sampler2D layer_coverage;

#ifndef PRT_PEEL
layout(std430, binding = PRT_BINDING_TOUCHING_RANGES) readonly buffer TouchingRanges {
    uvec2 touching_ranges[]; // per receiver: first triangle, one past the last
};
layout(std430, binding = PRT_BINDING_TOUCHING) readonly buffer Touching {
    vec4 touching[]; // three corners per triangle, relative to the origin of the receiver's rays
};
#endif

uniform uint receiver_count, direction_count;
uniform float texel_depth; // width of a texel in units of depth

// Maximum depth of a receiver behind a surface without a shadow: over one and a half texels the depth of the
// surface itself changes by this distance times the tangent of the angle of incidence.
float bias_of(float cosine) {
    float tangent = min(sqrt(max(0.0, 1.0 - cosine * cosine)) / cosine, 20.0);
    return texel_depth * (0.5 + 1.5 * tangent);
}

// Share of light that surfaces in front of `depth` transmit, bilinear over four texels.
float open_share(vec3 position, float cosine, int layer) {
    vec2 size = vec2(textureSize(opaque_depth, 0).xy), at = position.xy * size - 0.5, low = floor(at), f = at - low;
    float limit = position.z - bias_of(cosine);
    float shares[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(ivec2(low) + ivec2(i & 1, i >> 1), ivec2(0), ivec2(size) - 1);
#ifdef PRT_PEEL
        bool in_front = texelFetch(layer_depth, texel, 0).r < limit;
        shares[i] = in_front ? 1.0 - texelFetch(layer_coverage, texel, 0).r : 1.0;
#else
        shares[i] = texelFetch(opaque_depth, ivec3(texel, layer), 0).r < limit ? 0.0 : 1.0;
#endif
    }
    return mix(mix(shares[0], shares[1], f.x), mix(shares[2], shares[3], f.x), f.y);
}

#ifndef PRT_PEEL
// Whether a ray from the origin hits the triangle, by its side relative to the edges.
bool meets(uint triangle, vec3 direction) {
    vec3 a = touching[3u * triangle].xyz, b = touching[3u * triangle + 1u].xyz, c = touching[3u * triangle + 2u].xyz;
    float u = dot(cross(c, b), direction), v = dot(cross(a, c), direction), w = dot(cross(b, a), direction);
    vec3 normal = cross(b - a, c - a);
    float facing = dot(normal, direction);
    bool inside = min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0;
    return inside && facing != 0.0 && dot(normal, a) / facing > 0.0;
}

// Whether a triangle that touches the receiver blocks the direction.
bool touch_blocks(uint receiver, vec3 direction) {
    uvec2 range = touching_ranges[receiver];
    bool blocks = false;
    for (uint t = range.x; t < range.y; ++t)
        blocks = blocks || meets(t, direction);
    return blocks;
}
#endif

void main() {
    uint receiver = gl_GlobalInvocationID.x;
    if (receiver >= receiver_count)
        return;
    vec4 origin = vec4(receivers[receiver].origin.xyz, 1.0);
    vec3 normal = receivers[receiver].normal.xyz;
#ifdef PRT_PEEL
    float cosine = dot(normal, directions[0].towards_light.xyz);
    if (cosine > 1e-4)
        passes[receiver] *= open_share((directions[0].map_from_world * origin).xyz, cosine, 0);
#else
    uint first = receiver * uint(2 * PRT_COEFFICIENTS + 2);
    for (uint d = 0u; d < direction_count; ++d) {
        float cosine = max(dot(normal, directions[d].towards_light.xyz), 0.0), blocked = 0.0;
        if (cosine > 1e-4) {
            float open = open_share((directions[d].map_from_world * origin).xyz, cosine, int(d));
#ifdef PRT_ALPHA
            open *= passes[receiver];
            passes[receiver] = 1.0;
#endif
            open = touch_blocks(receiver, directions[d].towards_light.xyz) ? 0.0 : open;
            blocked = cosine * (1.0 - open);
        }
        if (cosine > 0.0)
            for (int k = 0; k < PRT_COEFFICIENTS; ++k) {
                sums[first + uint(k)] += cosine * directions[d].basis[k];
                sums[first + uint(PRT_COEFFICIENTS + k)] += blocked * directions[d].basis[k];
            }
        sums[first + uint(2 * PRT_COEFFICIENTS)] += cosine;
        sums[first + uint(2 * PRT_COEFFICIENTS + 1)] += blocked;
    }
#endif
}
