// Radiance of emissive surfaces, as on the CPU (bake/scene/surfaces.cpp, runtime/render/texture.cpp), at the
// finest level of the texture: rays to lamps average by themselves.

#include "bake_wrap.glsl"

layout(std430, binding = PRT_BINDING_EMISSION_IMAGES) readonly buffer EmissionImages {
    EmissionImage emission_images[];
};
layout(std430, binding = PRT_BINDING_EMISSION_TEXELS) readonly buffer EmissionTexels {
    uint emission_texels[];
};

vec3 emission_texel(EmissionImage image, int x, int y) {
    vec3 value = unpackUnorm4x8(emission_texels[image.texels + uint(y * image.width + x)]).rgb;
    vec3 decoded = mix(pow((value + 0.055) / 1.055, vec3(2.4)), value / 12.92, lessThanEqual(value, vec3(0.04045)));
    return image.linear != 0u ? value : decoded;
}

// Bilinear value of the texture; black for invalid coordinates.
vec3 emission_color(EmissionImage image, vec2 uv) {
    vec2 at = uv * vec2(image.width, image.height) - 0.5, low = floor(at), f = at - low;
    if (!(max(abs(at.x), abs(at.y)) < 1e9))
        return vec3(0.0);
    uint wrap_u = PRT_WRAP_U(image.wrap), wrap_v = PRT_WRAP_V(image.wrap);
    int x0 = wrapped(int(low.x), image.width, wrap_u), x1 = wrapped(int(low.x) + 1, image.width, wrap_u);
    int y0 = wrapped(int(low.y), image.height, wrap_v), y1 = wrapped(int(low.y) + 1, image.height, wrap_v);
    return mix(mix(emission_texel(image, x0, y0), emission_texel(image, x1, y0), f.x),
               mix(emission_texel(image, x0, y1), emission_texel(image, x1, y1), f.x), f.y);
}

vec3 emission(ShiningTriangle t, vec2 uv) {
    if (t.image == PRT_NO_TEXELS)
        return t.radiance;
    vec2 at = (1.0 - uv.x - uv.y) * t.texcoord[0] + uv.x * t.texcoord[1] + uv.y * t.texcoord[2];
    return t.radiance * emission_color(emission_images[t.image], at);
}
