#version 460
#extension GL_GOOGLE_include_directive : require

// Maximum squared norm of a receiver's vector in one channel, as bits: non-negative floats have the order of
// their bits.

#include "shared_bake.h"
#include "shared_structs.h"

layout(local_size_x = PRT_GATHER_THREADS) in;
layout(constant_id = PRT_CONSTANT_ORDER) const uint kOrder = 6u;

layout(std430, binding = PRT_BINDING_GATHERED) readonly buffer Gathered {
    float gathered[]; // [vectors][kOrder²]
};
layout(std430, binding = PRT_BINDING_ENERGY) buffer Energy {
    uint energy[]; // [bounces]
};
layout(push_constant) uniform Push {
    EnergyPush push;
};

void main() {
    uint vector = push.first + gl_GlobalInvocationID.x;
    if (vector >= push.end)
        return;
    float sum = 0.0;
    for (uint k = 0u; k < kOrder * kOrder; ++k) {
        float value = gathered[vector * kOrder * kOrder + k];
        sum += value * value;
    }
    atomicMax(energy[push.position], floatBitsToUint(sum));
}
