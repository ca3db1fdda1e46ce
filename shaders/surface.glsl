// Base color of the surface that a fragment shader draws: material, texture, vertex color, cut-outs. Linear.

#include "shared_layout.h"

in vec2 surface_texcoord;
in vec4 surface_color;

layout(binding = PRT_UNIT_BASE_COLOR) uniform sampler2D base_color_texture;
uniform bool textured; // multiply by base color
uniform bool has_texture;
uniform vec4 base_color;
uniform mat3x2 texture_transform;
uniform int alpha_mode; // PRT_ALPHA_*
uniform float alpha_cutoff;

// Computes the level of detail in the shader, because the formula of texture units differs between drivers.
vec4 filtered_texture(sampler2D image, vec2 uv) {
    vec2 size = vec2(textureSize(image, 0));
    vec2 dx = dFdx(uv) * size, dy = dFdy(uv) * size;
    float footprint = max(max(dot(dx, dx), dot(dy, dy)), 1e-12);
    return textureLod(image, uv, 0.5 * log2(footprint));
}

// Product of material, texture and vertex color.
vec4 material_color() {
    vec4 color = base_color * surface_color;
    if (has_texture)
        color *= filtered_texture(base_color_texture, texture_transform * vec3(surface_texcoord, 1.0));
    return color;
}

// Color and coverage; discards cut-out fragments.
vec4 surface_base_color() {
    vec4 base = vec4(1.0);
    if (textured) {
        base = material_color();
        if (alpha_mode == PRT_ALPHA_OPAQUE)
            base.a = 1.0;
        if (alpha_mode == PRT_ALPHA_MASK) {
            if (base.a < alpha_cutoff)
                discard;
            base.a = 1.0;
        }
    }
    return vec4(base.rgb, clamp(base.a, 0.0, 1.0));
}
