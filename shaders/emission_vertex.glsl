// Vertex data for a fragment shader with emission.glsl: read from a buffer, because weights of transfer may
// use all attributes.

#include "shared_layout.h"

layout(std430, binding = PRT_BINDING_EMISSION_TEXCOORDS) readonly buffer EmissionTexcoords {
    vec2 emission_texcoords[];
};

uniform bool has_emission_texture;

out vec2 emission_texcoord;

void take_for_emission() {
    emission_texcoord = has_emission_texture ? emission_texcoords[gl_VertexID] : vec2(0.0);
}
