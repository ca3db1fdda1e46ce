// Depth of surfaces that stop all light; with PRT_PEEL the depth of the next layer of blended surfaces behind
// the previous layer, and its coverage.

#include "shared_bake.h"
#include "shared_structs.h"
#ifdef PRT_ALPHA
#include "bake_alpha.glsl"
#endif

flat in uint alpha_index;
in vec2 barycentrics;

#ifdef PRT_PEEL
layout(binding = PRT_UNIT_OPAQUE_DEPTH) uniform sampler2DArray opaque_depth;
layout(binding = PRT_UNIT_LAST_DEPTH) uniform sampler2D last_depth;
out float layer_coverage;
#endif
uniform float texel_area; // area of a texel of the map, m²

void main() {
#ifdef PRT_ALPHA
    bool blended =
        alpha_index != 0u && alpha_materials[alpha_triangles[alpha_index - 1u].material].mode >= PRT_ALPHA_BLEND;
    float covered = coverage(alpha_index, barycentrics, texel_area);
#ifdef PRT_PEEL
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (!blended || gl_FragCoord.z <= texelFetch(last_depth, at, 0).r ||
        gl_FragCoord.z >= texelFetch(opaque_depth, ivec3(at, 0), 0).r)
        discard;
    layer_coverage = covered;
#else
    if (blended || covered == 0.0)
        discard;
#endif
#endif
}
