// Computes the exit radiance for albedo 1 of the texels of a lightmap (docs/format.md, "Texels"), one
// texel per thread. Dispatched when the lighting changes. Surfaces then sample the map like any texture, with
// filtering. Dispatch (width + 7) / 8 by (height + 7) / 8 groups, then generate mipmaps.
//
// Define before including: the definitions of prt_exit_radiance.glsl for packed weights and constants, and
//     PRT_LIGHTMAP_FORMAT    format of the image: rgba16f (default), r11f_g11f_b10f or rgba32f.

#ifndef PRT_LIGHTMAP_FORMAT
#define PRT_LIGHTMAP_FORMAT rgba16f
#endif

#define PRT_WORDS_OF_TEXEL
#include "prt_exit_radiance.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// R32UI textures, one per word of a texel.
layout(binding = PRT_UNIT_WORD_IMAGES) uniform highp usampler2D prt_word_images[PRT_PACKED_WORDS];
#ifdef VULKAN
layout(binding = PRT_UNIT_WORD_IMAGES + 1, PRT_LIGHTMAP_FORMAT) writeonly uniform image2D prt_lightmap;
#else
layout(binding = PRT_IMAGE_LIGHTMAP, PRT_LIGHTMAP_FORMAT) writeonly uniform image2D prt_lightmap;
#endif

const float kMaxHalf = 65504.0; // filters and mipmaps would spread values beyond the range of half floats

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(prt_lightmap);
    if (any(greaterThanEqual(texel, size)))
        return;
    prt_words_0 = prt_words_1 = uvec4(0u);
    for (int i = 0; i < PRT_PACKED_WORDS; ++i) {
        uint word = texelFetch(prt_word_images[i], texel, 0).r;
        if (i < 4)
            prt_words_0[i] = word;
        else
            prt_words_1[i - 4] = word;
    }
    vec3 radiance = prt_exit_radiance(vec3(0.0), vec3(0.0)); // texels have no predictors
    imageStore(prt_lightmap, texel, vec4(clamp(radiance, vec3(-kMaxHalf), vec3(kMaxHalf)), 1.0));
}
