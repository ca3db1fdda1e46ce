// Vertex data for a fragment shader with sun_light.glsl: read from buffers, because weights of transfer may
// use all attributes.

#include "sun_view.glsl"
#include "vertex_normals.glsl"

layout(std430, binding = PRT_BINDING_FACTOR_TEXCOORDS) readonly buffer FactorTexcoords {
    vec2 factor_texcoords[];
};
layout(std430, binding = PRT_BINDING_TINT_TEXCOORDS) readonly buffer TintTexcoords {
    vec2 tint_texcoords[];
};

uniform bool has_transmission_factor, has_transmission_tint; // textures

out vec3 seen; // position relative to the eye
out vec3 sun_normal;
out vec2 factor_texcoord, tint_texcoord;

void take_for_suns(vec3 position) {
    seen = position - suns_seen.eye.xyz;
    sun_normal = normal_of_vertex();
    factor_texcoord = has_transmission_factor ? factor_texcoords[gl_VertexID] : vec2(0.0);
    tint_texcoord = has_transmission_tint ? tint_texcoords[gl_VertexID] : vec2(0.0);
}
