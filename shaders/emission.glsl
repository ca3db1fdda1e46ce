// Radiance that a surface emits.

#include "surface.glsl"

in vec2 emission_texcoord;

layout(binding = PRT_UNIT_EMISSION) uniform sampler2D emission_texture;
uniform vec3 emission; // multiplied by the strength of its lamp
uniform bool has_emission_texture;
uniform mat3x2 emission_transform;

vec3 emitted_radiance() {
    if (!has_emission_texture)
        return emission;
    return emission * filtered_texture(emission_texture, emission_transform * vec3(emission_texcoord, 1.0)).rgb;
}
