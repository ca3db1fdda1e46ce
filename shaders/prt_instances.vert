// Complete vertex shader of instances that share transfer: a starting point for your shader. The matrix of an
// instance and its rows of prt::InstanceRelighter::table are instance attributes.

#include "prt_instances.glsl"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
#ifdef PRT_PREDICTOR_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 normal;
#else
const vec3 normal = vec3(0.0);
#endif
layout(location = PRT_LOCATION_INSTANCE_0) in vec4 instance_0;
layout(location = PRT_LOCATION_INSTANCE_1) in vec4 instance_1;
layout(location = PRT_LOCATION_INSTANCE_X) in vec4 world_x; // rows of the matrix to the world
layout(location = PRT_LOCATION_INSTANCE_Y) in vec4 world_y;
layout(location = PRT_LOCATION_INSTANCE_Z) in vec4 world_z;

#ifdef VULKAN
layout(push_constant) uniform Camera {
    mat4 view_projection;
};
layout(location = 0) out vec3 radiance;
#else
uniform mat4 view_projection;
out vec3 radiance;
#endif

void main() {
    radiance = prt_instance_radiance(instance_0, instance_1, position, normal);
    vec4 point = vec4(position, 1.0);
    gl_Position = view_projection * vec4(dot(world_x, point), dot(world_y, point), dot(world_z, point), 1.0);
}
