// Computes the exit radiance for albedo 1 of a vertex of an instance that shares the transfer of its mesh
// (docs/math.md, section 22). Define PRT_INSTANCES in addition to the definitions for prt_exit_radiance.glsl.
// The constants are those of prt::InstanceRelighter. They do not fit into uniform blocks. Without
// PRT_INSTANCES this file contains only prt_exit_radiance.

#include "prt_exit_radiance.glsl"

#ifdef PRT_INSTANCES
// Computes exit radiance from the two rows of the instance in prt::InstanceRelighter::table, which are instance
// attributes; `position` and `normal` are those of the mesh in its own frame.
vec3 prt_instance_radiance(vec4 instance_0, vec4 instance_1, vec3 position, vec3 normal) {
    prt_first_row = uint(instance_0.w) + (uint(instance_1.w) << 16);
    prt_position = vec4((position - instance_0.xyz) * instance_1.xyz, 1.0);
    return prt_exit_radiance(position, normal);
}
#endif
