// Coverage of surfaces that are cut out, blended or glass, as on the CPU (bake/scene/surfaces.cpp,
// runtime/render/texture.cpp).

#include "bake_wrap.glsl"

layout(std430, binding = PRT_BINDING_ALPHA_TRIANGLES) readonly buffer AlphaTriangles {
    AlphaTriangle alpha_triangles[];
};
layout(std430, binding = PRT_BINDING_ALPHA_MATERIALS) readonly buffer AlphaMaterials {
    AlphaMaterial alpha_materials[];
};
layout(std430, binding = PRT_BINDING_ALPHA_TEXELS) readonly buffer AlphaTexels {
    uint alpha_texels[]; // four per word
};

float alpha_texel(uint first, int x, int y, int width) {
    uint i = first + uint(y * width + x);
    return float(bitfieldExtract(alpha_texels[i >> 2], int(i & 3u) * 8, 8)) / 255.0;
}

float bilinear_alpha(AlphaMaterial m, int level, vec2 uv) {
    uint first = m.texels;
    int width = m.width, height = m.height;
    for (int l = 0; l < level; ++l) {
        first += uint(width * height);
        width = max(1, width / 2);
        height = max(1, height / 2);
    }
    vec2 at = uv * vec2(width, height) - 0.5, low = floor(at), f = at - low;
    if (!(max(abs(at.x), abs(at.y)) < 1e9)) // invalid coordinates: an opaque black
        return m.mode == PRT_ALPHA_GLASS ? 0.0 : 1.0;
    uint wrap_u = PRT_WRAP_U(m.wrap), wrap_v = PRT_WRAP_V(m.wrap);
    int x0 = wrapped(int(low.x), width, wrap_u), x1 = wrapped(int(low.x) + 1, width, wrap_u);
    int y0 = wrapped(int(low.y), height, wrap_v), y1 = wrapped(int(low.y) + 1, height, wrap_v);
    return mix(mix(alpha_texel(first, x0, y0, width), alpha_texel(first, x1, y0, width), f.x),
               mix(alpha_texel(first, x0, y1, width), alpha_texel(first, x1, y1, width), f.x), f.y);
}

float layer_coverage_of(AlphaTriangle t, vec2 uv, float footprint) {
    AlphaMaterial m = alpha_materials[t.material];
    vec3 b = vec3(1.0 - uv.x - uv.y, uv);
    float alpha = m.factor * (b.x * t.vertex_alpha[0] + b.y * t.vertex_alpha[1] + b.z * t.vertex_alpha[2]);
    if (m.texels != PRT_NO_TEXELS) {
        vec2 at = b.x * t.texcoord[0] + b.y * t.texcoord[1] + b.z * t.texcoord[2];
        float lod = 0.0;
        if (m.mode >= PRT_ALPHA_BLEND && footprint * t.texel_density > 0.0)
            lod = clamp(0.5 * log2(footprint * t.texel_density), 0.0, float(m.levels - 1));
        int fine = int(lod), coarse = min(fine + 1, m.levels - 1);
        alpha *= mix(bilinear_alpha(m, fine, at), bilinear_alpha(m, coarse, at), lod - float(fine));
    }
    if (m.mode == PRT_ALPHA_MASK)
        return alpha >= m.cutoff ? 1.0 : 0.0;
    alpha = clamp(alpha, 0.0, 1.0);
    return m.mode == PRT_ALPHA_GLASS ? 1.0 - alpha : alpha;
}

// Share of light that a triangle stops. `index` counts from 1; 0: opaque.
float coverage(uint index, vec2 uv, float footprint) {
    if (index == 0u)
        return 1.0;
    AlphaTriangle t = alpha_triangles[index - 1u];
    float covered = layer_coverage_of(t, uv, footprint);
    if (t.next != 0u)
        covered *= layer_coverage_of(alpha_triangles[t.next - 1u], uv, footprint);
    return covered;
}
