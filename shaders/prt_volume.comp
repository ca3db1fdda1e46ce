// Computes the light of the probes of a volume for prt_volume.glsl, like prt::VolumeRelighter::update: one
// texel per thread. Dispatched when the lighting changes. The number of groups along each axis is the size of
// the atlas in bricks.
//
// Define before including: the definitions of prt_exit_radiance.glsl for packed weights and constants, and
//     PRT_VOLUME_ORDER n      order of incident light, 2..4
//     PRT_VOLUME_FORMAT       format of the image: rgba16f (default) or rgba32f.
// The constants are those of prt::VolumeRelighter::update_constants.

#ifndef PRT_VOLUME_FORMAT
#define PRT_VOLUME_FORMAT rgba16f
#endif

#define PRT_WORDS_OF_TEXEL
#include "prt_exit_radiance.glsl"

layout(local_size_x = 5, local_size_y = 5, local_size_z = 5) in;

layout(std430, binding = PRT_BINDING_VOLUME_WORDS) readonly buffer PrtVolumeWords {
    uint prt_volume_words[]; // [probes][PRT_PACKED_WORDS]
};
layout(std430, binding = PRT_BINDING_VOLUME_PROBES) readonly buffer PrtVolumeProbes {
    uint prt_volume_probes[]; // [bricks][125], x varies fastest, then y, then z
};
#ifdef VULKAN
layout(binding = PRT_UNIT_VOLUME_LIGHT, PRT_VOLUME_FORMAT) writeonly uniform image3D prt_volume_image;
#else
layout(binding = PRT_IMAGE_VOLUME, PRT_VOLUME_FORMAT) writeonly uniform image3D prt_volume_image;
#endif

#define PRT_VOLUME_OUTPUTS (PRT_VOLUME_ORDER * PRT_VOLUME_ORDER)
#define PRT_VOLUME_NUMBERS (3 * PRT_VOLUME_OUTPUTS + 1)

const float kMaxHalf = 65504.0;

vec4 prt_sums[PRT_VOLUME_OUTPUTS];

vec4 prt_output_constant(uint row) {
#ifdef PRT_CONSTANTS_TEXTURE
    return texelFetch(prt_constants, ivec2(row % uint(PRT_TEXTURE_WIDTH), row / uint(PRT_TEXTURE_WIDTH)), 0);
#else
    return prt_constants[row];
#endif
}

// Adds all outputs of row `row` of the clusters.
void prt_add_outputs(uint row, float weight) {
    for (int o = 0; o < PRT_VOLUME_OUTPUTS; ++o)
        prt_sums[o] += weight * prt_output_constant(row * uint(PRT_VOLUME_OUTPUTS) + uint(o));
}

#ifdef PRT_CLUSTER_ROWS
#undef PRT_ADD
#define PRT_ADD(j, weight) prt_add_outputs(first + 1u + j, weight);

void prt_add_cluster() {
    uint first = prt_cluster_of_vertex() * uint(PRT_CLUSTER_ROWS);
    prt_add_outputs(first, 1.0);
    PRT_SAME_WEIGHTS
}
#else
void prt_add_cluster() {
    uvec4 cluster = prt_layout_of(prt_cluster_of_vertex());
    uint row = cluster[PRT_CLUSTER_FIRST_ROW], bit = uint(PRT_CLUSTER_BITS);
    prt_add_outputs(row, 1.0);
    for (uint j = 0u; j < cluster[PRT_CLUSTER_COMPONENTS]; ++j) {
        uint width =
            1u + ((j < 8u ? cluster[PRT_CLUSTER_WIDTHS] : cluster[PRT_CLUSTER_WIDTHS + 1]) >> (4u * (j & 7u)) & 15u);
        prt_add_outputs(row + 1u + j, float(prt_bits(bit, width)));
        bit += width;
    }
}
#endif

// Returns number `n` of a texel, counted over all planes.
float prt_number(int n) {
    if (n < 3 * PRT_VOLUME_OUTPUTS)
        return prt_sums[n / 3][n % 3];
    return n == 3 * PRT_VOLUME_OUTPUTS ? clamp(prt_sums[0].w, 0.0, 1.0) : 0.0;
}

void main() {
    uvec3 bricks = gl_NumWorkGroups, brick = gl_WorkGroupID;
    uint entry = ((brick.z * bricks.y + brick.y) * bricks.x + brick.x) * 125u + gl_LocalInvocationIndex;
    if (entry >= uint(prt_volume_probes.length()))
        return;
    prt_words_0 = prt_words_1 = uvec4(0u);
    for (int i = 0; i < PRT_PACKED_WORDS; ++i) {
        uint word = prt_volume_words[prt_volume_probes[entry] * uint(PRT_PACKED_WORDS) + uint(i)];
        if (i < 4)
            prt_words_0[i] = word;
        else
            prt_words_1[i - 4] = word;
    }
    for (int o = 0; o < PRT_VOLUME_OUTPUTS; ++o)
        prt_sums[o] = vec4(0.0);
    prt_add_cluster();
    for (int n = 0; n < PRT_VOLUME_NUMBERS; n += 4) {
        vec4 numbers = vec4(prt_number(n), prt_number(n + 1), prt_number(n + 2), prt_number(n + 3));
        ivec3 texel = ivec3(gl_GlobalInvocationID) + ivec3(0, 0, 5 * int(bricks.z) * (n / 4));
        imageStore(prt_volume_image, texel, clamp(numbers, vec4(-kMaxHalf), vec4(kMaxHalf)));
    }
}
