// The constants of all clusters for a lighting, instead of prt::ConstantFormer::form: one row per thread. Define
// PRT_ROWS, PRT_CHANNELS and PRT_COEFFICIENTS (order²). Dispatch (PRT_ROWS + 63) / 64 groups.

#include "shared_layout.h"

layout(local_size_x = 64) in;

// What prt::ConstantFormer::matrix gives: [rows / 16][channels][coefficients][16].
layout(std430, binding = PRT_BINDING_MATRIX) readonly buffer PrtMatrix {
    float prt_matrix[];
};
layout(std430, binding = PRT_BINDING_LIGHT) readonly buffer PrtLight {
    vec4 prt_light[]; // rgb of a coefficient
};
layout(std430, binding = PRT_BINDING_CONSTANTS) writeonly buffer PrtConstants {
    vec4 prt_constants[];
};

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= uint(PRT_ROWS))
        return;
    uint at = row / 16u * uint(16 * PRT_CHANNELS * PRT_COEFFICIENTS) + row % 16u;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i) {
#if PRT_CHANNELS == 1
        sum += prt_matrix[at + 16u * i] * prt_light[i].rgb;
#else
        sum += vec3(prt_matrix[at + 16u * i], prt_matrix[at + 16u * (i + uint(PRT_COEFFICIENTS))],
                    prt_matrix[at + 16u * (i + uint(2 * PRT_COEFFICIENTS))]) *
               prt_light[i].rgb;
#endif
    }
    prt_constants[row] = vec4(sum, 0.0);
}
