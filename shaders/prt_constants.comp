// Computes the constants of all clusters for a lighting on the GPU, like prt::ClusterLighting::update: one
// row per thread. Define PRT_ROWS and the lines of prt::term_defines. Dispatch (PRT_ROWS + 63) / 64 groups.

#include "shared_layout.h"

layout(local_size_x = 64) in;

// Result of prt::ClusterLighting::matrix: [rows / 16][numbers of a transfer vector][16].
layout(std430, binding = PRT_BINDING_MATRIX) readonly buffer PrtMatrix {
    float prt_matrix[];
};
layout(std430, binding = PRT_BINDING_LIGHT) readonly buffer PrtLight {
    vec4 prt_light[]; // rgb: result of prt::light_columns
};
layout(std430, binding = PRT_BINDING_CONSTANTS) writeonly buffer PrtConstants {
    vec4 prt_constants[];
};

#define PRT_TRANSFER(at, i) prt_matrix[(at) + 16u * (i)]
#define PRT_LIGHT(i) prt_light[i].rgb
#include "prt_terms.glsl"

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= uint(PRT_ROWS))
        return;
    uint at = row / 16u * uint(16 * PRT_NUMBERS) + row % 16u;
    prt_constants[row] = vec4(prt_lit_vector(at), 0.0);
}
