// Computes the exit radiance for albedo 1 of the texels of a lightmap (docs/format.md, "Texels").
// Drawn to a target of the map's size when the lighting changes. Surfaces then sample the map like any
// texture, with filtering. For GLSL 3.3, GLSL ES 3.0 and later.
//
// Define before including: the definitions of prt_exit_radiance.glsl for packed weights and constants, and
//     PRT_NORMALIZED_WORDS   if the images of words are RGBA8 textures, as browsers create them; default: RGBA8UI.
// The shader fetches single texels of the images, without filters. The images must not have mipmaps, color
// conversion or multiplication by alpha.

#define PRT_WORDS_OF_TEXEL
#include "prt_exit_radiance.glsl"

#ifdef PRT_NORMALIZED_WORDS
#define PRT_BYTES(image) uvec4(255.0 * texelFetch(prt_word_images[image], ivec2(gl_FragCoord.xy), 0) + 0.5)
PRT_SAMPLER(PRT_UNIT_WORD_IMAGES) sampler2D prt_word_images[PRT_PACKED_WORDS];
#else
#define PRT_BYTES(image) texelFetch(prt_word_images[image], ivec2(gl_FragCoord.xy), 0)
PRT_SAMPLER(PRT_UNIT_WORD_IMAGES) usampler2D prt_word_images[PRT_PACKED_WORDS];
#endif

layout(location = 0) out vec4 prt_texel;

// Filters and mipmaps would spread values beyond the range of half floats.
const float kMaxHalf = 65504.0;

uint prt_word_of(uvec4 bytes) {
    return bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24;
}

void main() {
    // GLSL ES requires constant indices into arrays of samplers.
    prt_words_0 = prt_words_1 = uvec4(0u);
    prt_words_0.x = prt_word_of(PRT_BYTES(0));
#if PRT_PACKED_WORDS > 1
    prt_words_0.y = prt_word_of(PRT_BYTES(1));
#endif
#if PRT_PACKED_WORDS > 2
    prt_words_0.z = prt_word_of(PRT_BYTES(2));
#endif
#if PRT_PACKED_WORDS > 3
    prt_words_0.w = prt_word_of(PRT_BYTES(3));
#endif
#if PRT_PACKED_WORDS > 4
    prt_words_1.x = prt_word_of(PRT_BYTES(4));
#endif
#if PRT_PACKED_WORDS > 5
    prt_words_1.y = prt_word_of(PRT_BYTES(5));
#endif
#if PRT_PACKED_WORDS > 6
    prt_words_1.z = prt_word_of(PRT_BYTES(6));
#endif
#if PRT_PACKED_WORDS > 7
    prt_words_1.w = prt_word_of(PRT_BYTES(7));
#endif
    vec3 radiance = prt_exit_radiance(vec3(0.0), vec3(0.0)); // texels have no predictors
    prt_texel = vec4(clamp(radiance, -kMaxHalf, kMaxHalf), 1.0);
}
