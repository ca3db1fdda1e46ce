// Computes the exit radiance of a vertex for albedo 1 from compressed transfer (docs/math.md, eq. 29). For
// GLSL 4.5 and 3.3, GLSL ES 3.0 and Vulkan; HLSL is generated from the Vulkan version (docs/integration.md).
//
// Define before including (prt::relight_defines writes the lines for a model)
//     PRT_PACKED_WORDS n     packed weights: n 32-bit words per vertex, 1..8, and PRT_CLUSTER_BITS b, or
//     PRT_WEIGHT_VECTORS n   floats: the number of VEC4 weight attributes, 0..12 (0: clusters only).
// If all clusters have the same layout; then there is no loop and no table of clusters:
//     PRT_CLUSTER_ROWS n     number of rows per cluster, and
//     PRT_SAME_WEIGHTS       PRT_ADD(j, weight) for every weight j; a packed weight is PRT_BITS(position, width).
// If the words are variables that the shader sets, instead of vertex attributes (prt_lightmap.frag):
//     PRT_WORDS_OF_TEXEL     packed words only.
// Predictors: data of the vertex that clusters use in addition to its weights:
//     PRT_PREDICTOR_NORMAL       the normal,
//     PRT_PREDICTOR_POSITION     the position relative to PRT_PREDICTOR_ORIGIN, a vec3: numbers, or the name of a
//                                uniform.
// Storage of the constants, which contain the data of prt::ClusterLighting and prt::cluster_layouts:
//     PRT_CONSTANTS_BUFFER   storage buffers (the default; OpenGL 4.3, Vulkan, Direct3D 11),
//     PRT_CONSTANTS_BLOCK    uniform blocks, with PRT_MAX_ROWS and PRT_MAX_CLUSTERS, or
//     PRT_CONSTANTS_TEXTURE  textures with PRT_TEXTURE_WIDTH texels per row, RGBA32F and RGBA32UI.

#include "shared_layout.h"

// If the language has no binding layout, the program must bind blocks and samplers by name.
#if defined(VULKAN) || (!defined(GL_ES) && __VERSION__ >= 420)
#define PRT_BINDING(number) , binding = number
#define PRT_SAMPLER(number) layout(binding = number) uniform highp
#else
#define PRT_BINDING(number)
#define PRT_SAMPLER(number) uniform highp
#endif

#if defined(PRT_CONSTANTS_BLOCK)
layout(std140 PRT_BINDING(PRT_BINDING_CONSTANTS)) uniform PrtConstants {
    vec4 prt_constants[PRT_MAX_ROWS];
};
#elif defined(PRT_CONSTANTS_TEXTURE)
PRT_SAMPLER(PRT_BINDING_CONSTANTS) sampler2D prt_constants;
#else
layout(std430 PRT_BINDING(PRT_BINDING_CONSTANTS)) readonly buffer PrtConstants {
    vec4 prt_constants[];
};
#endif

vec4 prt_constant_at(uint at) {
#ifdef PRT_CONSTANTS_TEXTURE
    return texelFetch(prt_constants, ivec2(at % uint(PRT_TEXTURE_WIDTH), at / uint(PRT_TEXTURE_WIDTH)), 0);
#else
    return prt_constants[at];
#endif
}

// Returns row `row` of the constants of all clusters: a color. For an instance, the color is linear in the
// position.
#ifdef PRT_INSTANCES
#define PRT_COLOR mat3x4
uint prt_first_row; // first row of the instance, and position of the vertex in the mesh's box: prt_instances.glsl
vec4 prt_position;

mat3x4 prt_constant(uint row) {
    uint at = 3u * (prt_first_row + row);
    return mat3x4(prt_constant_at(at), prt_constant_at(at + 1u), prt_constant_at(at + 2u));
}

vec3 prt_color(mat3x4 color) {
    return prt_position * color;
}
#else
#define PRT_COLOR vec3

vec3 prt_constant(uint row) {
    return prt_constant_at(row).rgb;
}

vec3 prt_color(vec3 color) {
    return color;
}
#endif

// The table of clusters.
#ifndef PRT_CLUSTER_ROWS
#if defined(PRT_CONSTANTS_BLOCK)
layout(std140 PRT_BINDING(PRT_BINDING_CLUSTERS)) uniform PrtClusters {
    uvec4 prt_clusters[PRT_MAX_CLUSTERS];
};
#elif defined(PRT_CONSTANTS_TEXTURE)
PRT_SAMPLER(PRT_BINDING_CLUSTERS) usampler2D prt_clusters;
#else
layout(std430 PRT_BINDING(PRT_BINDING_CLUSTERS)) readonly buffer PrtClusters {
    uvec4 prt_clusters[];
};
#endif

// Returns the entry of a cluster, indexed by PRT_CLUSTER_*: first row, number of components, widths of weights
// 0 to 7, widths of weights 8 to 15.
uvec4 prt_layout_of(uint cluster) {
#ifdef PRT_CONSTANTS_TEXTURE
    return texelFetch(prt_clusters, ivec2(cluster % uint(PRT_TEXTURE_WIDTH), cluster / uint(PRT_TEXTURE_WIDTH)), 0);
#else
    return prt_clusters[cluster];
#endif
}
#endif

// Offsets of rows from the first row of a cluster: the position predictor, and the first basis direction.
#ifdef PRT_PREDICTOR_NORMAL
#define PRT_POSITION_ROW 4u
#else
#define PRT_POSITION_ROW 1u
#endif
#ifdef PRT_PREDICTOR_POSITION
#define PRT_DIRECTION_ROW (PRT_POSITION_ROW + 3u)
#else
#define PRT_DIRECTION_ROW PRT_POSITION_ROW
#endif

// Returns the mean of the cluster with first row `first` plus the contribution of the predictors.
PRT_COLOR prt_predicted(uint first, vec3 position, vec3 normal) {
    PRT_COLOR radiance = prt_constant(first);
#ifdef PRT_PREDICTOR_NORMAL
    radiance +=
        normal.x * prt_constant(first + 1u) + normal.y * prt_constant(first + 2u) + normal.z * prt_constant(first + 3u);
#endif
#ifdef PRT_PREDICTOR_POSITION
    vec3 point = position - PRT_PREDICTOR_ORIGIN;
    radiance += point.x * prt_constant(first + PRT_POSITION_ROW) +
                point.y * prt_constant(first + PRT_POSITION_ROW + 1u) +
                point.z * prt_constant(first + PRT_POSITION_ROW + 2u);
#endif
    return radiance;
}

// Data of a vertex: its cluster and its weights.

#ifdef PRT_PACKED_WORDS
#ifdef PRT_WORDS_OF_TEXEL
uvec4 prt_words_0, prt_words_1;
#else
layout(location = PRT_LOCATION_WEIGHTS) in uvec4 prt_words_0;
#if PRT_PACKED_WORDS > 4
layout(location = PRT_LOCATION_WEIGHTS_1) in uvec4 prt_words_1;
#endif
#endif

uint prt_word(uint index) {
#if PRT_PACKED_WORDS > 4
    return index < 4u ? prt_words_0[index] : prt_words_1[index - 4u];
#elif PRT_PACKED_WORDS > 1
    return prt_words_0[index];
#else
    return prt_words_0.x;
#endif
}

// Returns `width` bits of the words, starting at bit `position`; width <= 16. A weight may span two words.
uint prt_bits(uint position, uint width) {
    uint word = position >> 5, shift = position & 31u;
    uint bits = prt_word(word) >> shift;
#if PRT_PACKED_WORDS > 1
    if (shift + width > 32u)
        bits |= prt_word(word + 1u) << (32u - shift);
#endif
    return bits & ((1u << width) - 1u);
}

uint prt_cluster_of_vertex() {
    return prt_bits(0u, uint(PRT_CLUSTER_BITS));
}
#else
layout(location = PRT_LOCATION_CLUSTER) in uint prt_cluster;
#if PRT_WEIGHT_VECTORS > 0
layout(location = PRT_LOCATION_WEIGHTS) in vec4 prt_weights_0;
#endif
#if PRT_WEIGHT_VECTORS > 1
layout(location = PRT_LOCATION_WEIGHTS_1) in vec4 prt_weights_1;
#endif
#if PRT_WEIGHT_VECTORS > 2
layout(location = PRT_LOCATION_WEIGHTS_2) in vec4 prt_weights_2;
#endif
#if PRT_WEIGHT_VECTORS > 3
layout(location = PRT_LOCATION_WEIGHTS_3) in vec4 prt_weights_3;
#endif
#if PRT_WEIGHT_VECTORS > 4
layout(location = PRT_LOCATION_WEIGHTS_4) in vec4 prt_weights_4;
#endif
#if PRT_WEIGHT_VECTORS > 5
layout(location = PRT_LOCATION_WEIGHTS_5) in vec4 prt_weights_5;
#endif
#if PRT_WEIGHT_VECTORS > 6
layout(location = PRT_LOCATION_WEIGHTS_6) in vec4 prt_weights_6;
#endif
#if PRT_WEIGHT_VECTORS > 7
layout(location = PRT_LOCATION_WEIGHTS_7) in vec4 prt_weights_7;
#endif
#if PRT_WEIGHT_VECTORS > 8
layout(location = PRT_LOCATION_WEIGHTS_8) in vec4 prt_weights_8;
#endif
#if PRT_WEIGHT_VECTORS > 9
layout(location = PRT_LOCATION_WEIGHTS_9) in vec4 prt_weights_9;
#endif
#if PRT_WEIGHT_VECTORS > 10
layout(location = PRT_LOCATION_WEIGHTS_10) in vec4 prt_weights_10;
#endif
#if PRT_WEIGHT_VECTORS > 11
layout(location = PRT_LOCATION_WEIGHTS_11) in vec4 prt_weights_11;
#endif

uint prt_cluster_of_vertex() {
    return prt_cluster;
}
#endif

// vec3 prt_exit_radiance(vec3 position, vec3 normal): returns the exit radiance. Both arguments are those of
// the baked model, in its frame; the normal is unit, or zero if the mesh has none. Arguments that the model
// does not use as predictors are ignored.

#if defined(PRT_CLUSTER_ROWS)
// One line, because GLSL 3.30 has no line continuation.
#define PRT_BITS(at, width) float(prt_bits(at, width))
#define PRT_ADD(j, weight) radiance += weight * prt_constant(first + PRT_DIRECTION_ROW + j);

vec3 prt_exit_radiance(vec3 position, vec3 normal) {
    uint first = prt_cluster_of_vertex() * uint(PRT_CLUSTER_ROWS);
    PRT_COLOR radiance = prt_predicted(first, position, normal);
    PRT_SAME_WEIGHTS
    return prt_color(radiance);
}
#elif defined(PRT_PACKED_WORDS)
vec3 prt_exit_radiance(vec3 position, vec3 normal) {
    uvec4 cluster = prt_layout_of(prt_cluster_of_vertex());
    uint first = cluster[PRT_CLUSTER_FIRST_ROW];
    PRT_COLOR radiance = prt_predicted(first, position, normal);
    uint bit = uint(PRT_CLUSTER_BITS);
    for (uint j = 0u; j < cluster[PRT_CLUSTER_COMPONENTS]; ++j) {
        uint width =
            1u + ((j < 8u ? cluster[PRT_CLUSTER_WIDTHS] : cluster[PRT_CLUSTER_WIDTHS + 1]) >> (4u * (j & 7u)) & 15u);
        radiance += float(prt_bits(bit, width)) * prt_constant(first + PRT_DIRECTION_ROW + j);
        bit += width;
    }
    return prt_color(radiance);
}
#else
// One line, because GLSL 3.30 has no line continuation.
// clang-format off
#define PRT_ADD_FOUR(w) for (uint i = 0u; i < 4u && j < components; ++i, ++j) radiance += w[i] * prt_constant(first + PRT_DIRECTION_ROW + j);
// clang-format on

vec3 prt_exit_radiance(vec3 position, vec3 normal) {
    uvec4 cluster = prt_layout_of(prt_cluster_of_vertex());
    uint first = cluster[PRT_CLUSTER_FIRST_ROW], components = cluster[PRT_CLUSTER_COMPONENTS];
    PRT_COLOR radiance = prt_predicted(first, position, normal);
    uint j = 0u;
#if PRT_WEIGHT_VECTORS > 0
    PRT_ADD_FOUR(prt_weights_0)
#endif
#if PRT_WEIGHT_VECTORS > 1
    PRT_ADD_FOUR(prt_weights_1)
#endif
#if PRT_WEIGHT_VECTORS > 2
    PRT_ADD_FOUR(prt_weights_2)
#endif
#if PRT_WEIGHT_VECTORS > 3
    PRT_ADD_FOUR(prt_weights_3)
#endif
#if PRT_WEIGHT_VECTORS > 4
    PRT_ADD_FOUR(prt_weights_4)
#endif
#if PRT_WEIGHT_VECTORS > 5
    PRT_ADD_FOUR(prt_weights_5)
#endif
#if PRT_WEIGHT_VECTORS > 6
    PRT_ADD_FOUR(prt_weights_6)
#endif
#if PRT_WEIGHT_VECTORS > 7
    PRT_ADD_FOUR(prt_weights_7)
#endif
#if PRT_WEIGHT_VECTORS > 8
    PRT_ADD_FOUR(prt_weights_8)
#endif
#if PRT_WEIGHT_VECTORS > 9
    PRT_ADD_FOUR(prt_weights_9)
#endif
#if PRT_WEIGHT_VECTORS > 10
    PRT_ADD_FOUR(prt_weights_10)
#endif
#if PRT_WEIGHT_VECTORS > 11
    PRT_ADD_FOUR(prt_weights_11)
#endif
    return prt_color(radiance);
}
#endif
