// Directions of a receiver's rays, equal to those on the CPU (bake/trace/chunk_kernels.cpp): Owen-scrambled
// Sobol points by the hash of Laine and Karras (2011) in the form of Vegdahl (2021), and the concentric map
// of Shirley and Chiu (1997).

#include "shared_samples.h"
#include "bake_frame.glsl"

layout(std430, binding = PRT_BINDING_SAMPLES) readonly buffer Samples {
    uvec2 sobol[]; // reversed Sobol points of a whole chunk, then of the last chunk
};

float to_signed_unit(uint v) {
    return (float(v >> 8) + 0.5) * (1.0 / 8388608.0) - 1.0;
}

vec3 ray_direction(uvec2 point, uint seed, mat3 frame) {
    float u = to_signed_unit(bitfieldReverse(laine_karras(point.x, pcg_hash(seed))));
    float v = to_signed_unit(bitfieldReverse(laine_karras(point.y, pcg_hash(seed ^ 0x9e3779b9u))));
    bool wide = abs(u) > abs(v);
    float radius = wide ? u : v;
    float angle = 0.785398163 * (wide ? v : u) / radius;
    float a2 = angle * angle;
    float sine = angle * (1.0 + a2 * (-1.0 / 6.0 + a2 * (1.0 / 120.0 + a2 * (-1.0 / 5040.0 + a2 * (1.0 / 362880.0)))));
    float cosine = 1.0 + a2 * (-0.5 + a2 * (1.0 / 24.0 + a2 * (-1.0 / 720.0 + a2 * (1.0 / 40320.0))));
    return frame * vec3(radius * (wide ? cosine : sine), radius * (wide ? sine : cosine),
                        sqrt(max(0.0, 1.0 - radius * radius)));
}

// Points of the sequence are linear over GF(2): point (first + j) is point j XOR point `first`.
uvec2 sobol_offset(uint first) {
    uint column = 1u, y = 0u, index = first;
    while (index != 0u) {
        if ((index & 1u) != 0u)
            y ^= column;
        column ^= column << 1;
        index >>= 1;
    }
    return uvec2(first, y);
}
