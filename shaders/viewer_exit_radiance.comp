// Exit radiance of every receiver from its raw transfer vector. Define the terms as prt_terms.glsl requires.

#include "shared_layout.h"
#include "shared_viewer.h"

layout(local_size_x = 64) in;

layout(std430, binding = PRT_BINDING_MATRIX) readonly buffer Transfer {
    float transfer[]; // [receivers][numbers of a transfer vector]
};
layout(std430, binding = PRT_BINDING_LIGHT) readonly buffer Light {
    vec4 light[];
};
layout(std430, binding = PRT_BINDING_RAW_RADIANCE) writeonly buffer Radiance {
    float radiance[]; // [receivers][3]
};

uniform uint receivers; // number in this piece
uniform uint first;     // first receiver of the piece in `radiance`

#define PRT_TRANSFER(at, i) transfer[(at) + (i)]
#define PRT_LIGHT(i) light[i].rgb
#include "prt_terms.glsl"

void main() {
    uint receiver = gl_GlobalInvocationID.x;
    if (receiver < receivers) {
        vec3 sum = prt_lit_vector(receiver * uint(PRT_NUMBERS));
        for (uint c = 0u; c < 3u; ++c)
            radiance[3u * (first + receiver) + c] = sum[c];
    }
}
