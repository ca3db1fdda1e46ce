// The whole vertex shader of instances that share transfer: a start for one of your own. The instance is that of
// gl_InstanceID, from `first_instance` on; where it stands is the program's own.

#include "prt_instances.glsl"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
#ifdef PRT_GUIDE_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 normal;
#else
const vec3 normal = vec3(0.0);
#endif

#ifdef VULKAN
layout(push_constant) uniform Camera {
    mat4 view_projection;
    uint first_instance;
};
#define PRT_INSTANCE_INDEX uint(gl_InstanceIndex)
layout(location = 0) out vec3 radiance;
#else
uniform mat4 view_projection;
uniform uint first_instance;
#define PRT_INSTANCE_INDEX uint(gl_InstanceID)
out vec3 radiance;
#endif

void main() {
    radiance = prt_instance_radiance(first_instance + PRT_INSTANCE_INDEX, position, normal);
    gl_Position = view_projection * vec4(position, 1.0);
}
