// Computes the texels of a lightmap, or the light of the probes of a volume for prt_volume.glsl (docs/format.md,
// texels and probes of PRTKIT_transfer), like prt::TextureRelighter::update: one texel per thread.
// Dispatched when the lighting changes.
//     Lightmap: dispatch (width + 7) / 8 by (height + 7) / 8 groups, then generate mipmaps. A texel is exit
//     radiance for albedo 1. Surfaces sample the map like any texture, with filtering.
//     Volume: the number of groups along each axis is the size of the atlas in bricks.
//
// Define before including: the definitions of prt_exit_radiance.glsl for packed weights and constants, and
//     PRT_OUTPUTS n           volume: number of coefficients of incident light, 4, 9 or 16; default: lightmap,
//     PRT_TEXEL_FORMAT        format of the image: rgba16f (default), rgba32f; lightmap: also r11f_g11f_b10f.
// The constants are those of prt::TextureRelighter::update_constants.

#ifndef PRT_TEXEL_FORMAT
#define PRT_TEXEL_FORMAT rgba16f
#endif
#ifndef PRT_OUTPUTS
#define PRT_OUTPUTS 1
#endif

#define PRT_WORDS_OF_TEXEL
#include "prt_exit_radiance.glsl"

#if PRT_OUTPUTS > 1
layout(local_size_x = 5, local_size_y = 5, local_size_z = 5) in;

layout(std430, binding = PRT_BINDING_VOLUME_WORDS) readonly buffer PrtVolumeWords {
    uint prt_volume_words[]; // [probes][PRT_PACKED_WORDS]
};
layout(std430, binding = PRT_BINDING_VOLUME_PROBES) readonly buffer PrtVolumeProbes {
    uint prt_volume_probes[]; // [bricks][125], x varies fastest, then y, then z
};
layout(binding = PRT_IMAGE_TEXELS, PRT_TEXEL_FORMAT) writeonly uniform image3D prt_texels;
#else
layout(local_size_x = 8, local_size_y = 8) in;

// R32UI textures, one per word of a texel.
layout(binding = PRT_UNIT_WORD_IMAGES) uniform highp usampler2D prt_word_images[PRT_PACKED_WORDS];
layout(binding = PRT_IMAGE_TEXELS, PRT_TEXEL_FORMAT) writeonly uniform image2D prt_texels;
#endif

const float kMaxHalf = 65504.0; // filters and mipmaps would spread values beyond the range of half floats

vec4 prt_sums[PRT_OUTPUTS];

// Adds all outputs of row `row` of the clusters.
void prt_add_outputs(uint row, float weight) {
    for (int o = 0; o < PRT_OUTPUTS; ++o)
        prt_sums[o] += weight * prt_constant_at(row * uint(PRT_OUTPUTS) + uint(o));
}

void prt_add_cluster() {
#ifdef PRT_CLUSTER_ROWS
#undef PRT_ADD
#define PRT_ADD(j, weight) prt_add_outputs(first + 1u + j, weight);
    uint first = prt_cluster_of_vertex() * uint(PRT_CLUSTER_ROWS);
    prt_add_outputs(first, 1.0);
    PRT_SAME_WEIGHTS
#else
    uvec4 cluster = prt_layout_of(prt_cluster_of_vertex());
    uint row = cluster[PRT_CLUSTER_FIRST_ROW], bit = uint(PRT_CLUSTER_BITS);
    prt_add_outputs(row, 1.0);
    for (uint j = 0u; j < cluster[PRT_CLUSTER_COMPONENTS]; ++j) {
        uint width =
            1u + ((j < 8u ? cluster[PRT_CLUSTER_WIDTHS] : cluster[PRT_CLUSTER_WIDTHS + 1]) >> (4u * (j & 7u)) & 15u);
        prt_add_outputs(row + 1u + j, float(prt_bits(bit, width)));
        bit += width;
    }
#endif
}

// Returns number `n` of a receiver, counted over all planes: the colors, then visibility of the sun or alpha.
float prt_number(int n) {
    if (n < 3 * PRT_OUTPUTS)
        return prt_sums[n / 3][n % 3];
#if PRT_OUTPUTS > 1
    return n == 3 * PRT_OUTPUTS ? clamp(prt_sums[0].w, 0.0, 1.0) : 0.0;
#else
    return 1.0;
#endif
}

void main() {
#if PRT_OUTPUTS > 1
    uvec3 bricks = gl_NumWorkGroups, brick = gl_WorkGroupID;
    uint entry = ((brick.z * bricks.y + brick.y) * bricks.x + brick.x) * 125u + gl_LocalInvocationIndex;
    if (entry >= uint(prt_volume_probes.length()))
        return;
    uint first = prt_volume_probes[entry] * uint(PRT_PACKED_WORDS);
#define PRT_WORD(i) prt_volume_words[first + uint(i)]
    ivec3 texel = ivec3(gl_GlobalInvocationID), plane = ivec3(0, 0, 5 * int(bricks.z));
#else
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), plane = ivec2(0);
    if (any(greaterThanEqual(texel, imageSize(prt_texels))))
        return;
#define PRT_WORD(i) texelFetch(prt_word_images[i], texel, 0).r
#endif
    prt_words_0 = prt_words_1 = uvec4(0u);
    for (int i = 0; i < PRT_PACKED_WORDS; ++i)
        if (i < 4)
            prt_words_0[i] = PRT_WORD(i);
        else
            prt_words_1[i - 4] = PRT_WORD(i);
    for (int o = 0; o < PRT_OUTPUTS; ++o)
        prt_sums[o] = vec4(0.0);
    prt_add_cluster();
    for (int n = 0; n < 3 * PRT_OUTPUTS + 1; n += 4) {
        vec4 numbers = vec4(prt_number(n), prt_number(n + 1), prt_number(n + 2), prt_number(n + 3));
        imageStore(prt_texels, texel + n / 4 * plane, clamp(numbers, vec4(-kMaxHalf), vec4(kMaxHalf)));
    }
}
