// Computes the light that moving objects block at receivers near them (docs/math.md, section 20). For GLSL 4.5
// and 3.3, GLSL ES 3.0 and Vulkan:
//
//     float prt_occluders_visibility(vec3 position, vec3 normal)
//         Returns the share of light from a uniform environment that is not blocked.
//     float prt_occluders_sun(vec3 position, vec3 towards, float half_angle)
//         Returns the share of the light of a sun that is not blocked, with a soft shadow; 0: full shadow.
//         `half_angle`: half angle of the sun in radians.
// If prt_volume.glsl was included before, also:
//     vec3 prt_occluders_light(vec3 position, vec3 normal, vec3 light[PRT_VOLUME_COEFFICIENTS])
//         Returns the share of the incident light `light` that is not blocked.
//
// `position` is in metres in the world of the occluders; `normal` and `towards` are unit.
//
// The objects are the results of prt::placed, selected by prt::occluders_near. They are in a uniform block of
// this file, or in these, if they are defined:
//     PRT_OCCLUDER_ROWS     an array of vec4, five per object, and
//     PRT_OCCLUDER_COUNT    an int.
// PRT_MAX_OCCLUDERS: capacity of the block.

#include "shared_layout.h"

// If the language has no binding layout, the program must bind the block and the sampler by name.
#if defined(VULKAN) || (!defined(GL_ES) && __VERSION__ >= 420)
layout(binding = PRT_UNIT_OCCLUDERS) uniform highp sampler3D prt_occluder_texture;
#else
uniform highp sampler3D prt_occluder_texture;
#endif

#ifndef PRT_OCCLUDER_ROWS
#if defined(VULKAN) || (!defined(GL_ES) && __VERSION__ >= 420)
layout(std140, binding = PRT_BINDING_OCCLUDERS) uniform PrtOccluders {
#else
layout(std140) uniform PrtOccluders {
#endif
    vec4 prt_occluder_rows[5 * PRT_MAX_OCCLUDERS];
    ivec4 prt_occluder_count; // in x
};
#define PRT_OCCLUDER_ROWS prt_occluder_rows
#define PRT_OCCLUDER_COUNT prt_occluder_count.x
#endif

// A cap of the sphere around a position, with uniform occlusion.
struct PrtBlockedCap {
    vec3 towards;  // unit, center of the cap
    float share;   // share of all directions
    float density; // blocked share of the cap
};

PrtBlockedCap prt_blocked_cap(int i, vec3 position) {
    vec4 point = vec4(position, 1.0), half_reach = PRT_OCCLUDER_ROWS[5 * i + 3];
    vec3 x = PRT_OCCLUDER_ROWS[5 * i].xyz, y = PRT_OCCLUDER_ROWS[5 * i + 1].xyz, z = PRT_OCCLUDER_ROWS[5 * i + 2].xyz;
    vec3 q = vec3(dot(PRT_OCCLUDER_ROWS[5 * i], point), dot(PRT_OCCLUDER_ROWS[5 * i + 1], point),
                  dot(PRT_OCCLUDER_ROWS[5 * i + 2], point));
    float far = length(q);
    PrtBlockedCap cap = PrtBlockedCap(vec3(0.0, 1.0, 0.0), 0.0, 0.0);
    if (far < half_reach.w) {
        const float kSide = float(PRT_OCCLUDER_SIDE);
        // Outside the box, use the point on its surface in the direction of the center. Beyond it, the solid
        // angle decreases with the square of the distance.
        vec3 sides = q / half_reach.xyz, sizes = abs(sides);
        float outside = max(max(sizes.x, sizes.y), max(sizes.z, 1.0));
        vec3 texels = vec3(kSide, kSide, float(textureSize(prt_occluder_texture, 0).z));
        vec3 at = (0.5 * sides / outside + 0.5) * (kSide - 1.0) + 0.5;
        at.z += kSide * PRT_OCCLUDER_ROWS[5 * i + 4].x;
        vec4 stored = textureLod(prt_occluder_texture, at / texels, 0.0);
        float root = (0.5 * stored.w + 0.5) / outside;
        vec3 blocked_direction = stored.xyz;
        float blocked = root * root * (1.0 - smoothstep(PRT_OCCLUDER_FADE, 1.0, far / half_reach.w));
        vec3 rotated = blocked_direction.x * x + blocked_direction.y * y + blocked_direction.z * z;
        float size = length(rotated);
        if (blocked > 0.0) {
            cap.share = max(1.0 - (1.0 - blocked) * min(size, 1.0), blocked);
            cap.density = blocked / cap.share;
            cap.towards = size > 0.0 ? rotated / size : cap.towards;
        }
    }
    return cap;
}

// Returns the angle of a cosine. The built-in `acos` of a driver may have errors of 1e-4.
float prt_angle_of(float cosine) {
    return atan(sqrt(max(1.0 - cosine * cosine, 0.0)), cosine);
}

// Returns the share of the cosine-weighted hemisphere that a cap covers. `share`: size of the cap, at most
// half of the sphere; `cosine`: cosine of the angle between its center and the normal.
float prt_cap_cosine(float share, float cosine) {
    float squared = 4.0 * share * (1.0 - share), rest = squared - cosine * cosine;
    float sum = max(cosine, 0.0) * squared;
    if (rest > 0.0) { // the horizon intersects the cap
        float cut = sqrt(rest), far = 1.0 - 2.0 * share;
        float y = clamp(-cosine * far / sqrt((1.0 - cosine * cosine) * squared), -1.0, 1.0);
        sum = clamp((squared * cosine * prt_angle_of(y) - cut * far + atan(cut, far)) * 0.318309886, 0.0, 1.0);
    }
    return sum;
}

// Returns the share of light from a uniform environment that a cap blocks.
float prt_blocked_cosine(PrtBlockedCap cap, vec3 normal) {
    float cosine = clamp(dot(cap.towards, normal), -1.0, 1.0);
    return cap.density *
           (cap.share > 0.5 ? 1.0 - prt_cap_cosine(1.0 - cap.share, -cosine) : prt_cap_cosine(cap.share, cosine));
}

float prt_blocked_sun(PrtBlockedCap cap, vec3 towards, float half_angle) {
    float from_middle = prt_angle_of(clamp(dot(cap.towards, towards), -1.0, 1.0));
    float radius = prt_angle_of(clamp(1.0 - 2.0 * cap.share, -1.0, 1.0)),
          border = PRT_OCCLUDER_BORDER * radius + half_angle;
    float inside = clamp((radius + border - from_middle) / max(2.0 * border, 1e-6), 0.0, 1.0);
    return cap.density * inside * inside * (3.0 - 2.0 * inside);
}

float prt_occluders_visibility(vec3 position, vec3 normal) {
    float left = 1.0;
    for (int i = 0; i < PRT_OCCLUDER_COUNT; ++i)
        left *= 1.0 - prt_blocked_cosine(prt_blocked_cap(i, position), normal);
    return left;
}

float prt_occluders_sun(vec3 position, vec3 towards, float half_angle) {
    float left = 1.0;
    for (int i = 0; i < PRT_OCCLUDER_COUNT; ++i)
        left *= 1.0 - prt_blocked_sun(prt_blocked_cap(i, position), towards, half_angle);
    return left;
}

#ifdef PRT_VOLUME_ORDER
// Weights the blocked share of each object by the light from its direction, relative to all incident light:
// an object in front of a bright sky blocks more.
vec3 prt_occluders_light(vec3 position, vec3 normal, vec3 light[PRT_VOLUME_COEFFICIENTS]) {
    vec3 all = max(prt_incident_irradiance(light, normal), vec3(1e-12)), left = vec3(1.0);
    for (int i = 0; i < PRT_OCCLUDER_COUNT; ++i) {
        PrtBlockedCap cap = prt_blocked_cap(i, position);
        float blocked = prt_blocked_cosine(cap, normal);
        if (blocked > 0.0)
            left *= clamp(1.0 - blocked * prt_incident_radiance(light, cap.towards) / all, 0.0, 1.0);
    }
    return left;
}
#endif
