// Exit radiance of every receiver from its raw transfer vector. Define PRT_CHANNELS and PRT_COEFFICIENTS (order²).

#include "shared_layout.h"
#include "shared_viewer.h"

layout(local_size_x = 64) in;

layout(std430, binding = PRT_BINDING_MATRIX) readonly buffer Transfer {
    float transfer[]; // [receivers][channels][order²]
};
layout(std430, binding = PRT_BINDING_LIGHT) readonly buffer Light {
    vec4 light[];
};
layout(std430, binding = PRT_BINDING_RAW_RADIANCE) writeonly buffer Radiance {
    float radiance[]; // [receivers][3]
};

uniform uint receivers; // in this piece
uniform uint first;     // of the piece, in `radiance`

void main() {
    uint receiver = gl_GlobalInvocationID.x;
    if (receiver < receivers) {
        uint at = receiver * uint(PRT_CHANNELS * PRT_COEFFICIENTS);
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < uint(PRT_COEFFICIENTS); ++i) {
#if PRT_CHANNELS == 1
            sum += transfer[at + i] * light[i].rgb;
#else
            sum += light[i].rgb * vec3(transfer[at + i], transfer[at + uint(PRT_COEFFICIENTS) + i],
                                       transfer[at + uint(2 * PRT_COEFFICIENTS) + i]);
#endif
        }
        for (uint c = 0u; c < 3u; ++c)
            radiance[3u * (first + receiver) + c] = sum[c];
    }
}
