// Radiance of a moving vertex from its lobes: under the light of the volume (PRT_VOLUME) at its position, or
// of an unoccluded sky.

#include "shared_viewer.h"
#ifdef PRT_VOLUME
#include "prt_volume.glsl"
#endif
#include "prt_lobes.glsl"

layout(std430, binding = PRT_BINDING_LOBE_WORDS) readonly buffer LobeWords {
    uint lobe_words[]; // [vertices of the figure][PRT_LOBES]
};

uniform int first_vertex; // first vertex of the vertex array
#ifndef PRT_VOLUME
uniform vec3 sky_sh[PRT_LOBE_COEFFICIENTS];
#endif

vec3 radiance_of_lobes(mat3 matrix, vec3 position, vec3 normal) {
    PrtLobe lobes[PRT_LOBES];
    mat3 rotation = prt_lobe_rotation(matrix);
    for (int k = 0; k < PRT_LOBES; ++k) {
        uint word = lobe_words[(first_vertex + gl_VertexID) * PRT_LOBES + k];
        vec4 bytes = vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24);
        lobes[k] = prt_rotated_lobe(prt_lobe(bytes), rotation);
    }
#ifdef PRT_VOLUME
    return prt_lobes_in_volume(lobes, position, normal);
#else
    return prt_lobes_radiance(lobes, sky_sh);
#endif
}
