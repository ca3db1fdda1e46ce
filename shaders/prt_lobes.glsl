// Computes exit radiance of skinned vertices from one to three zonal lobes per vertex, which rotate with the
// skin (docs/math.md, section 21; docs/format.md, PRTKIT_lobes). For GLSL 4.5 and 3.3, GLSL ES 3.0 and Vulkan:
//
//     PrtLobe prt_lobe(vec4 bytes)
//         Decodes attribute _PRT_LOBE_k, components 0..255. The lobe is in the frame of NORMAL.
//     mat3 prt_lobe_rotation(mat3 matrix)
//         Returns the rotation of lobes. `matrix` is the skin matrix of the vertex, blended by its weights.
//     PrtLobe prt_rotated_lobe(PrtLobe lobe, mat3 rotation)
//         Rotates a lobe to world axes.
//     PrtLobe prt_mapped_lobe(PrtLobe lobe, vec3 from, vec3 to)
//         Rotates a lobe for a normal map: `from` is the vertex normal, `to` is the normal of the map.
//     vec3 prt_lobe_sum(PrtLobe lobe, vec3 light[PRT_LOBE_COEFFICIENTS])
//         Returns the exit radiance of one lobe; it may be negative.
//     vec3 prt_lobes_radiance(PrtLobe lobes[PRT_LOBES], vec3 light[PRT_LOBE_COEFFICIENTS])
//         Returns the exit radiance of all lobes for albedo 1.
// If prt_volume.glsl was included before, also:
//     vec3 prt_lobes_in_volume(PrtLobe lobes[PRT_LOBES], vec3 position, vec3 normal)
//         Returns the exit radiance of all lobes for albedo 1 under the light of the volume at a position.
//
// `light` is defined in docs/format.md: coefficients L_lm of radiance per color, in world axes.
//
// Define before including
//     PRT_LOBES n            lobes per vertex, 1..3,
//     PRT_LOBE_ORDER n       number of bands of `light`, 2..4; default: that of the volume. Higher bands of lobes
//                            are ignored.
// If the profiles are not in the uniform block of this file:
//     PRT_LOBE_PROFILE(i)    a vec4: gains of bands 0 to 3 of profile i, 0 beyond the order of the file.

#include "shared_layout.h"

#ifndef PRT_LOBE_ORDER
#define PRT_LOBE_ORDER PRT_VOLUME_ORDER
#endif
#define PRT_LOBE_COEFFICIENTS (PRT_LOBE_ORDER * PRT_LOBE_ORDER)

#ifndef PRT_LOBE_PROFILE
#if defined(VULKAN) || (!defined(GL_ES) && __VERSION__ >= 420)
layout(std140, binding = PRT_BINDING_LOBES) uniform PrtLobeProfiles {
#else
layout(std140) uniform PrtLobeProfiles {
#endif
    vec4 prt_lobe_profiles[PRT_MAX_PROFILES];
};
#define PRT_LOBE_PROFILE(i) prt_lobe_profiles[i]
#endif

struct PrtLobe {
    vec3 axis;  // unit
    vec4 gains; // gains of bands 0 to 3
};

PrtLobe prt_lobe(vec4 bytes) {
    vec2 p = min((bytes.xy - 127.0) / 127.0, vec2(1.0));
    float z = 1.0 - abs(p.x) - abs(p.y);
    if (z < 0.0) // the lower half of the octahedron is folded over the corners
        p = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0) * (1.0 - abs(p.yx));
    return PrtLobe(normalize(vec3(p, z)), bytes.w / 255.0 * PRT_LOBE_PROFILE(int(bytes.z + 0.5)));
}

// Uses the cofactors of the matrix, as for normals, so that an unoccluded vertex is lit by its normal in
// every pose.
mat3 prt_lobe_rotation(mat3 m) {
    mat3 rotation = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return dot(m[0], rotation[0]) < 0.0 ? -rotation : rotation;
}

PrtLobe prt_rotated_lobe(PrtLobe lobe, mat3 rotation) {
    vec3 axis = rotation * lobe.axis;
    float size = length(axis);
    return PrtLobe(size > 0.0 ? axis / size : lobe.axis, lobe.gains);
}

// Rotates a lobe by the smallest rotation that maps unit `from` to unit `to`.
PrtLobe prt_mapped_lobe(PrtLobe lobe, vec3 from, vec3 to) {
    vec3 both = from + to;
    float size = 1.0 + dot(from, to);
    vec3 axis = lobe.axis - dot(both, lobe.axis) / max(size, 1e-6) * both + 2.0 * dot(from, lobe.axis) * to;
    return PrtLobe(size < 1e-6 ? -lobe.axis : axis, lobe.gains);
}

// Returns the sum over l of gain_l times the sum over m of Y_lm(axis) L_lm (docs/math.md, eq. 1 to 3).
vec3 prt_lobe_sum(PrtLobe lobe, vec3 light[PRT_LOBE_COEFFICIENTS]) {
    vec3 n = lobe.axis;
    vec4 gains = lobe.gains;
    vec3 sum = gains[0] * 0.282094792 * light[0];
    sum += gains[1] * 0.488602512 * (-n.y * light[1] + n.z * light[2] - n.x * light[3]);
#if PRT_LOBE_ORDER > 2
    sum += gains[2] *
           (1.092548431 * (n.x * n.y * light[4] - n.y * n.z * light[5] - n.x * n.z * light[7]) +
            0.315391565 * (3.0 * n.z * n.z - 1.0) * light[6] + 0.546274215 * (n.x * n.x - n.y * n.y) * light[8]);
#endif
#if PRT_LOBE_ORDER > 3
    vec3 s = n * n;
    sum += gains[3] *
           (-0.590043590 * n.y * (3.0 * s.x - s.y) * light[9] + 2.890611442 * n.x * n.y * n.z * light[10] -
            0.457045799 * n.y * (5.0 * s.z - 1.0) * light[11] + 0.373176333 * n.z * (5.0 * s.z - 3.0) * light[12] -
            0.457045799 * n.x * (5.0 * s.z - 1.0) * light[13] + 1.445305721 * n.z * (s.x - s.y) * light[14] -
            0.590043590 * n.x * (s.x - 3.0 * s.y) * light[15]);
#endif
    return sum;
}

vec3 prt_lobes_radiance(PrtLobe lobes[PRT_LOBES], vec3 light[PRT_LOBE_COEFFICIENTS]) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < PRT_LOBES; ++k)
        sum += prt_lobe_sum(lobes[k], light);
    return max(sum, vec3(0.0));
}

#ifdef PRT_VOLUME_ORDER
#if PRT_VOLUME_ORDER == PRT_LOBE_ORDER
vec3 prt_lobes_in_volume(PrtLobe lobes[PRT_LOBES], vec3 position, vec3 normal) {
    vec3 light[PRT_VOLUME_COEFFICIENTS];
    prt_volume_incident(position, normal, light);
    return prt_lobes_radiance(lobes, light);
}
#endif
#endif
