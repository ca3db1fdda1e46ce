// Ray intersection with triangles: the nearest one that stops some light, and the light that passes all of
// them. Uses ray queries of the device with PRT_RAY_QUERY, otherwise our hierarchy.

layout(std430, binding = PRT_BINDING_CORNERS) readonly buffer Corners {
    vec4 corners[]; // three per triangle; w: its index in the scene, its index in the alpha table, as bits
};

struct RayHit {
    uint triangle; // index in the scene
    float t;
    vec2 uv;
    bool back; // hit from behind
    float covered, footprint;
};

const float kFar = 3.402823e38;

// Whether a loop ended early, as it happens on some software devices, so that all later results are wrong.
bool cut_short = false;

// A ray and its spread: it represents an area of spread · t² divided by the cosine at the hit.
struct TracedRay {
    vec3 origin, direction; // unit
    float spread;
};

#include "bake_alpha.glsl"

vec3 area_vector(uint slot) {
    vec3 a = corners[3u * slot].xyz;
    return cross(corners[3u * slot + 1u].xyz - a, corners[3u * slot + 2u].xyz - a);
}

// Area that a ray represents at a hit. `direction`: direction of the ray in the space of the triangle's
// corners, which an instance rotates and scales.
float footprint_of(TracedRay ray, uint slot, float t, vec3 direction) {
    vec3 face = area_vector(slot);
    return ray.spread * t * t * length(face) * length(direction) / abs(dot(face, direction));
}

// Share of light that a triangle stops at a hit.
float covered_at(TracedRay ray, uint slot, float t, vec2 uv, vec3 direction) {
    uint alpha = floatBitsToUint(corners[3u * slot + 1u].w);
    if (!kAlpha || alpha == 0u)
        return 1.0;
    // In metres of the instance.
    float footprint = ray.spread > 0.0 ? footprint_of(ray, slot, t, direction) * dot(direction, direction) : 0.0;
    return coverage(alpha, uv, footprint);
}

// Next float above a distance, at which a ray continues behind a hit. GPUs may flush smaller values to 0.
float behind(float t) {
    return max(uintBitsToFloat(floatBitsToUint(abs(t)) + 1u), 1.17549435e-38);
}

#ifdef PRT_RAY_QUERY
#include "bake_query.glsl"
#else
#include "bake_bvh.glsl"
#endif
