#version 460
#extension GL_GOOGLE_include_directive : require

// Gathers light of other receivers: multiplies rows of a sparse matrix with exit transfer (docs/math.md,
// section 7). Adjacent threads process adjacent coefficients of the same row.

#include "shared_bake.h"
#include "shared_structs.h"
#include "bake_sums.glsl"

layout(local_size_x = PRT_GATHER_THREADS) in;
layout(constant_id = PRT_CONSTANT_ORDER) const uint kOrder = 6u;
layout(constant_id = PRT_CONSTANT_CHANNELS) const uint kChannels = 1u;
layout(constant_id = PRT_CONSTANT_ROW_THREADS) const uint kRowThreads = 64u; // a power of two
// An entry has one weight for all channels; the reflectance depends on the source.
layout(constant_id = PRT_CONSTANT_SHARED) const bool kShared = true;

layout(std430, binding = PRT_BINDING_ROW_ENDS) readonly buffer RowEnds {
    uint row_ends[]; // [rows + 1] first entry of each row, then the end of the last row
};
layout(std430, binding = PRT_BINDING_SOURCES) readonly buffer Sources {
    uint sources[]; // [entries]
};
layout(std430, binding = PRT_BINDING_WEIGHTS) readonly buffer Weights {
    float weights[]; // [entries][kChannels, or 1 if kShared]
};
layout(std430, binding = PRT_BINDING_REFLECTANCE) readonly buffer Reflectance {
    float reflectance[]; // [receivers][kChannels], if kShared
};
layout(std430, binding = PRT_BINDING_EXIT) readonly buffer Exit {
    float exit_transfer[]; // [receivers][kChannels][kOrder²]
};
layout(std430, binding = PRT_BINDING_GATHERED) writeonly buffer Gathered {
    float gathered[]; // [rows][kChannels][kOrder²], not if kSummed
};
layout(std430, binding = PRT_BINDING_TOTAL) buffer Total {
    float total[]; // [rows][kChannels][kOrder²] receives the sum of the gathered values, if push.add
};
layout(push_constant) uniform Push {
    GatherPush push;
};

void add_to_sums(uint row, uint columns, uint k, float value) {
    SumRow to = sum_rows[row];
    for (uint i = 0u; i < 3u; ++i)
        if (to.sums[i] != PRT_NO_SUM)
            atomicAdd(fixed_sums[to.sums[i] * columns + k], fixed_point(to.shares[i] * value / push.largest));
}

void main() {
    const uint kCoefficients = kOrder * kOrder, kColumns = kChannels * kCoefficients;
    uint row = push.first_row + gl_WorkGroupID.x * (uint(PRT_GATHER_THREADS) / kRowThreads) +
               gl_LocalInvocationID.x / kRowThreads;
    if (row >= push.end_row)
        return;
    uint begin = row_ends[row], end = row_ends[row + 1u];
    for (uint k = gl_LocalInvocationID.x % kRowThreads; k < kColumns; k += kRowThreads) {
        uint channel = k / kCoefficients;
        float sum = 0.0;
        for (uint e = begin; e < end; ++e) {
            uint source = sources[e];
            float weight =
                kShared ? weights[e] * reflectance[source * kChannels + channel] : weights[e * kChannels + channel];
            sum += weight * exit_transfer[source * kColumns + k];
        }
        uint position = (push.first_gathered + row) * kColumns + k;
        if (kSummed)
            add_to_sums(push.first_sum_row + row, kColumns, k, sum);
        else
            gathered[position] = sum;
        if (push.add != 0u)
            total[position] += sum;
    }
}
