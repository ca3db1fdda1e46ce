// Writes surfaces that stop all light of a sun to the depth of a map. With PRT_PARTLY, for surfaces that
// transmit a part: depths of the first and the last layer (blended by minimum), and the transmittance of all
// layers (multiplied).

#include "surface.glsl"
#include "shared_suns.h"

in vec2 surface_glass_texcoord;
in float depth;

layout(binding = PRT_UNIT_GLASS) uniform sampler2D glass_texture;
uniform bool has_glass_texture;
uniform bool glass_as_color; // the texture is used as a color elsewhere
uniform float glass;         // transmittance where the texture is 1
uniform mat3x2 glass_transform;

#ifdef PRT_PARTLY
layout(location = 0) out vec2 layers;
layout(location = 1) out float passes;
#endif

float srgb_encoded(float x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

// Coverage as in Surfaces::coverage. Cut-outs use the finest level.
float coverage() {
    float alpha = base_color.a * surface_color.a;
    if (has_texture) {
        vec2 uv = texture_transform * vec3(surface_texcoord, 1.0);
        alpha *= alpha_mode == PRT_ALPHA_MASK ? textureLod(base_color_texture, uv, 0.0).a
                                              : filtered_texture(base_color_texture, uv).a;
    }
    float covered = 1.0;
    if (alpha_mode == PRT_ALPHA_MASK)
        covered = alpha >= alpha_cutoff ? 1.0 : 0.0;
    if (alpha_mode == PRT_ALPHA_BLEND)
        covered = clamp(alpha, 0.0, 1.0);
    float through = glass;
    if (has_glass_texture) {
        float texel = filtered_texture(glass_texture, glass_transform * vec3(surface_glass_texcoord, 1.0)).r;
        through *= glass_as_color ? srgb_encoded(texel) : texel;
    }
    return covered * (1.0 - through);
}

void main() {
    float covered = coverage();
    if (covered == 0.0)
        discard;
#ifdef PRT_PARTLY
    layers = vec2(depth, -depth);
    passes = 1.0 - covered;
#endif
}
