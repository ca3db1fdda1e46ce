// Rays among triangles: the nearest that stops some light, and what passes all of them. By the device's own traversal
// with PRT_RAY_QUERY, else through our hierarchy.

layout(std430, binding = PRT_BINDING_CORNERS) readonly buffer Corners {
    vec4 corners[]; // three per triangle; w: its index in the scene, its place in the alpha table, as bits
};

struct RayHit {
    uint triangle; // in the scene's order
    float t;
    vec2 uv;
    bool back; // met from behind
    float covered, footprint;
};

const float kFar = 3.402823e38;

// Whether a loop ended before its time, as some software devices have them, so that all that follows is wrong.
bool cut_short = false;

// A ray, and what a texture must know: the area that it stands for is spread · t² over the cosine there.
struct TracedRay {
    vec3 origin, direction; // unit
    float spread;
};

#include "bake_alpha.glsl"

vec3 area_vector(uint slot) {
    vec3 a = corners[3u * slot].xyz;
    return cross(corners[3u * slot + 1u].xyz - a, corners[3u * slot + 2u].xyz - a);
}

// `direction`: that of the ray where the triangle's corners stand, which may be a copy of it, turned and scaled.
float footprint_of(TracedRay ray, uint slot, float t, vec3 direction) {
    vec3 face = area_vector(slot);
    return ray.spread * t * t * length(face) * length(direction) / abs(dot(face, direction));
}

// Share of light that a triangle stops there.
float covered_at(TracedRay ray, uint slot, float t, vec2 uv, vec3 direction) {
    uint alpha = floatBitsToUint(corners[3u * slot + 1u].w);
    if (!kAlpha || alpha == 0u)
        return 1.0;
    // In the metres of the copy.
    float footprint = ray.spread > 0.0 ? footprint_of(ray, slot, t, direction) * dot(direction, direction) : 0.0;
    return coverage(alpha, uv, footprint);
}

// The next number above a distance: where a ray goes on behind what it met. GPUs may take smaller ones for 0.
float behind(float t) {
    return max(uintBitsToFloat(floatBitsToUint(abs(t)) + 1u), 1.17549435e-38);
}

#ifdef PRT_RAY_QUERY
#include "bake_query.glsl"
#else
#include "bake_bvh.glsl"
#endif
