// Exit radiance of a vertex of an instance that shares the transfer of its mesh (docs/math.md, section 21), for a
// receiver of albedo 1. Beside what prt_exit_radiance.glsl wants, define PRT_INSTANCE_ROWS, the rows of the constants
// of one lighting. The constants are those of all turns, of each turn those of all modes one behind the other. For
// languages with storage buffers.

#include "shared_instances.h"

#include "prt_exit_radiance.glsl"

layout(std430 PRT_BINDING(PRT_BINDING_INSTANCES)) readonly buffer PrtInstances {
    vec4 prt_instances[];
};

// `position` and `normal` as the mesh has them, in its own frame.
vec3 prt_instance_radiance(uint instance, vec3 position, vec3 normal) {
    uint at = instance * PRT_INSTANCE_TABLE_ROWS;
    vec3 middle = prt_instances[at + PRT_INSTANCE_MODES].xyz,
         over_half = prt_instances[at + PRT_INSTANCE_MODES + 1u].xyz;
    vec4 place = vec4((position - middle) * over_half, 1.0);
    uint first_mode = uint(prt_instances[at + PRT_INSTANCE_PASSING].w) * PRT_INSTANCE_MODES;
    vec3 radiance = vec3(0.0);
    for (uint mode = 0u; mode < PRT_INSTANCE_MODES; ++mode) {
        vec4 row = prt_instances[at + mode];
        vec3 factor = mode < PRT_INSTANCE_PASSING ? vec3(dot(row, place)) : row.rgb;
        prt_first_row = (first_mode + mode) * uint(PRT_INSTANCE_ROWS);
        radiance += factor * prt_exit_radiance(position, normal);
    }
    return radiance;
}
