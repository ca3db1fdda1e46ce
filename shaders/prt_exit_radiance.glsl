// Exit radiance of a vertex from compressed transfer (docs/math.md, eq. 14), for a receiver of albedo 1.
//
// Define before including: PRT_WEIGHT_VECTORS, the number of VEC4 weight attributes (0: clusters only).
// The buffer holds, per cluster, prt_constants_per_cluster values as prt::form_constants writes them.

#include "shared_layout.h"

layout(std430, binding = PRT_BINDING_CONSTANTS) readonly buffer PrtConstants {
    vec4 prt_constants[];
};
uniform int prt_constants_per_cluster;

layout(location = PRT_LOCATION_CLUSTER) in uint prt_cluster;
#if PRT_WEIGHT_VECTORS > 0
layout(location = PRT_LOCATION_WEIGHTS) in vec4 prt_weights[PRT_WEIGHT_VECTORS];
#endif

vec3 prt_exit_radiance() {
    int row = int(prt_cluster) * prt_constants_per_cluster;
    vec3 radiance = prt_constants[row].rgb;
#if PRT_WEIGHT_VECTORS > 0
    for (int j = 1; j < prt_constants_per_cluster; ++j)
        radiance += prt_weights[(j - 1) >> 2][(j - 1) & 3] * prt_constants[row + j].rgb;
#endif
    return radiance;
}
