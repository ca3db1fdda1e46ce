// A right-handed orthonormal frame about a unit normal, equal to prt::tangent_frame (Duff et al. 2017,
// "Building an Orthonormal Basis, Revisited").
#ifndef PRT_BAKE_FRAME_GLSL
#define PRT_BAKE_FRAME_GLSL

mat3 tangent_frame(vec3 n) {
    float s = (floatBitsToUint(n.z) >> 31) != 0u ? -1.0 : 1.0;
    float a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

#endif
