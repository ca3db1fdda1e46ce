// Exit radiance of a vertex from compressed transfer (docs/math.md, eq. 14), for a receiver of albedo 1.
//
// Define before including
//     PRT_PACKED_WORDS n     packed weights: n 32-bit words per vertex, 1..8, and PRT_CLUSTER_BITS b, or
//     PRT_WEIGHT_VECTORS n   others: the number of VEC4 weight attributes (0: clusters only).
// The buffers hold what prt::cluster_layouts and prt::form_constants write.

#include "shared_layout.h"

layout(std430, binding = PRT_BINDING_CONSTANTS) readonly buffer PrtConstants {
    vec4 prt_constants[];
};
layout(std430, binding = PRT_BINDING_CLUSTERS) readonly buffer PrtClusters {
    uvec4 prt_clusters[]; // first row, components, widths of weights 0 to 7, 8 to 15
};

#ifdef PRT_PACKED_WORDS
layout(location = PRT_LOCATION_WEIGHTS) in uvec4 prt_words[(PRT_PACKED_WORDS + 3) / 4];

// `width` bits from bit `position` on, width <= 16. A weight may lie across two words.
uint prt_bits(uint position, uint width) {
    uint word = position >> 5, shift = position & 31u;
    uint bits = prt_words[word >> 2][word & 3u] >> shift;
    if (shift + width > 32u)
        bits |= prt_words[(word + 1u) >> 2][(word + 1u) & 3u] << (32u - shift);
    return bits & ((1u << width) - 1u);
}

vec3 prt_exit_radiance() {
    uvec4 cluster = prt_clusters[prt_bits(0u, PRT_CLUSTER_BITS)];
    vec3 radiance = prt_constants[cluster.x].rgb;
    uint position = PRT_CLUSTER_BITS;
    for (uint j = 0u; j < cluster.y; ++j) {
        uint width = 1u + (cluster[2u + (j >> 3)] >> (4u * (j & 7u)) & 15u);
        radiance += float(prt_bits(position, width)) * prt_constants[cluster.x + 1u + j].rgb;
        position += width;
    }
    return radiance;
}
#else
layout(location = PRT_LOCATION_CLUSTER) in uint prt_cluster;
#if PRT_WEIGHT_VECTORS > 0
layout(location = PRT_LOCATION_WEIGHTS) in vec4 prt_weights[PRT_WEIGHT_VECTORS];
#endif

vec3 prt_exit_radiance() {
    uvec4 cluster = prt_clusters[prt_cluster];
    vec3 radiance = prt_constants[cluster.x].rgb;
#if PRT_WEIGHT_VECTORS > 0
    for (uint j = 0u; j < cluster.y; ++j)
        radiance += prt_weights[j >> 2][j & 3u] * prt_constants[cluster.x + 1u + j].rgb;
#endif
    return radiance;
}
#endif
