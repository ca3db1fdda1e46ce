// Triangles of the scene in orthographic projection.

#include "shared_bake.h"

layout(std430, binding = PRT_BINDING_CORNERS) readonly buffer Corners {
    vec4 corners[]; // three per triangle; w of the second: index in the alpha table
};

uniform mat4 map_from_world;

flat out uint alpha_index;
out vec2 barycentrics;

void main() {
    int corner = gl_VertexID % 3;
    alpha_index = floatBitsToUint(corners[gl_VertexID - corner + 1].w);
    barycentrics = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
    gl_Position = map_from_world * vec4(corners[gl_VertexID].xyz, 1.0);
}
