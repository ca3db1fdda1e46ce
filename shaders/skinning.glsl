// Vertices that move with weighted matrices (prt/gltf/animation.h).

#include "shared_layout.h"

layout(std430, binding = PRT_BINDING_PALETTE) readonly buffer Palette {
    mat4 palette[];
};
layout(std430, binding = PRT_BINDING_INFLUENCES) readonly buffer Influences {
    uvec2 influences[]; // [vertices][influences_each] index of the matrix, and the bits of its weight
};

uniform int influences_each; // 0: all vertices use one matrix

mat4 vertex_matrix() {
    if (influences_each == 0)
        return palette[0];
    mat4 sum = mat4(0.0);
    float total = 0.0;
    for (int i = 0; i < influences_each; ++i) {
        uvec2 influence = influences[gl_VertexID * influences_each + i];
        float weight = uintBitsToFloat(influence.y);
        sum += weight * palette[influence.x];
        total += weight;
    }
    return sum / total;
}

// Transforms a normal by the cofactors of the matrix.
vec3 moved_normal(mat4 matrix, vec3 normal) {
    mat3 m = mat3(matrix);
    vec3 n = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])) * normal;
    return normalize(determinant(m) < 0.0 ? -n : n);
}
