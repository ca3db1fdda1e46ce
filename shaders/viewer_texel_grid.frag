// Draws borders of a lightmap's texels as lines on the surface, over a picture of it. Lines are one pixel
// wide, antialiased by derivatives, and fade where texels cover few pixels, separately for each axis of the
// map.

#include "surface.glsl"
#include "shared_layout.h"

layout(binding = PRT_UNIT_LIGHTMAP) uniform sampler2D lightmap;

in vec2 lightmap_texcoord;

uniform float samples;  // per pixel along each axis
uniform vec4 line_tint; // alpha: opacity

out vec4 result;

const float kNoLines = 3.0, kFullLines = 8.0; // size of a texel in pixels

void main() {
    vec2 position = lightmap_texcoord * vec2(textureSize(lightmap, 0)); // borders are at integers
    vec2 texels_a_sample =
        max(vec2(length(vec2(dFdx(position.x), dFdy(position.x))), length(vec2(dFdx(position.y), dFdy(position.y)))),
            vec2(1e-9));
    vec2 to_border = abs(fract(position - 0.5) - 0.5) / texels_a_sample; // in samples
    vec2 cover = clamp(0.5 + 0.5 * samples - to_border, 0.0, 1.0);
    cover *= smoothstep(kNoLines, kFullLines, 1.0 / (texels_a_sample * samples));
    surface_base_color(); // discards cut-out fragments
    result = vec4(line_tint.rgb, line_tint.a * max(cover.x, cover.y));
}
