// Texel index for an index outside the texture, as on the CPU (runtime/render/texture.cpp).
#ifndef PRT_BAKE_WRAP_GLSL
#define PRT_BAKE_WRAP_GLSL

int wrapped(int i, int size, uint wrap) {
    if (wrap == PRT_WRAP_CLAMP)
        return clamp(i, 0, size - 1);
    int period = wrap == PRT_WRAP_MIRROR ? 2 * size : size;
    int rest = i - period * (i / period); // has the sign of i
    rest = rest < 0 ? rest + period : rest;
    return rest < size ? rest : 2 * size - 1 - rest;
}

#endif
