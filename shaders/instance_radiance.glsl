// Exit radiance of a vertex of an instance, computed by viewer_lit_instances.vert when the light last
// changed.

#include "shared_viewer.h"

layout(std430, binding = PRT_BINDING_INSTANCE_RADIANCE) readonly buffer InstanceRadiance {
    uvec2 instance_radiance[]; // [instances][vertices] of the drawn mesh: four halves, the last one unused
};
layout(location = PRT_LOCATION_INSTANCE_0) in uint instance;
uniform uint instance_vertices;

vec3 radiance_of_vertex() {
    uvec2 halves = instance_radiance[instance * instance_vertices + uint(gl_VertexID)];
    return vec3(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y).x);
}
