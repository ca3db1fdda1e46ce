// Computes exit radiance of the vertices of instances, and stores it as halves in a buffer that
// instance_radiance.glsl reads in every frame until the light changes. Defines are those of
// prt_instances.glsl.

#include "prt_instances.glsl"
#include "shared_viewer.h"

layout(std430, binding = PRT_BINDING_INSTANCE_RADIANCE) writeonly buffer InstanceRadiance {
    uvec2 instance_radiance[]; // [instances][vertices] of the drawn mesh: four halves, the last one unused
};
uniform uint instance_vertices;
layout(location = PRT_LOCATION_POSITION) in vec3 position;
#ifdef PRT_PREDICTOR_NORMAL
layout(location = PRT_LOCATION_NORMAL) in vec3 normal;
#else
const vec3 normal = vec3(0.0);
#endif
layout(location = PRT_LOCATION_INSTANCE_0) in vec4 instance_0;
layout(location = PRT_LOCATION_INSTANCE_1) in vec4 instance_1;

void main() {
    vec3 radiance = prt_instance_radiance(instance_0, instance_1, position, normal);
    instance_radiance[uint(gl_InstanceID) * instance_vertices + uint(gl_VertexID)] =
        uvec2(packHalf2x16(radiance.rg), packHalf2x16(vec2(radiance.b, 0.0)));
    gl_Position = vec4(0.0);
}
