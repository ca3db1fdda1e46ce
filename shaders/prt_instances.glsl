// Exit radiance of a vertex of an instance that shares the transfer of its mesh (docs/math.md, section 22), for a
// receiver of albedo 1. Beside what prt_exit_radiance.glsl wants, define PRT_INSTANCES. The constants are those that
// prt::InstanceFormer forms; uniform blocks have no room for them. Without it there is prt_exit_radiance alone.

#include "prt_exit_radiance.glsl"

#ifdef PRT_INSTANCES
// The two rows of the instance in prt::InstanceFormer::table, which are attributes of the instance; `position` and
// `normal` as the mesh has them, in its own frame.
vec3 prt_instance_radiance(vec4 instance_0, vec4 instance_1, vec3 position, vec3 normal) {
    prt_first_row = uint(instance_0.w) + (uint(instance_1.w) << 16);
    prt_place = vec4((position - instance_0.xyz) * instance_1.xyz, 1.0);
    return prt_exit_radiance(position, normal);
}
#endif
