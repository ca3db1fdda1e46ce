// Complete vertex shader of a relit model: a starting point for your shader.

#include "prt_exit_radiance.glsl"

layout(location = PRT_LOCATION_POSITION) in vec3 position;
#ifdef PRT_PREDICTOR_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 normal;
#else
const vec3 normal = vec3(0.0);
#endif

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
    radiance = prt_exit_radiance(position, normal); // multiply by the albedo in the fragment shader
    gl_Position = view_projection * vec4(position, 1.0);
}
