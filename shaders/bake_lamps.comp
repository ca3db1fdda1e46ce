#version 460
#extension GL_GOOGLE_include_directive : require

// Irradiance of receivers from one lamp without a bounce (docs/math.md, section 13), with the samples of the
// CPU (bake/trace/lamp_rays.cpp). One thread per receiver: the threads of a group process the same lights and
// triangles at the same time, so that their rays are coherent.

#include "bake_kernel.glsl"
#include "shared_samples.h"
#include "shared_lamps.h"
#include "bake_frame.glsl"
#include "bake_traversal.glsl"
#include "bake_emission.glsl"

layout(local_size_x = PRT_LAMP_THREADS) in;

layout(std430, binding = PRT_BINDING_RECEIVERS) readonly buffer Receivers {
    LampReceiver receivers[];
};
layout(std430, binding = PRT_BINDING_SUMS) buffer Sums {
    vec4 sums[]; // per receiver: irradiance, and number of rays
};
layout(std430, binding = PRT_BINDING_PUNCTUAL_LIGHTS) readonly buffer Lights {
    PunctualLight lights[];
};
layout(std430, binding = PRT_BINDING_SHINING_TRIANGLES) readonly buffer ShiningTriangles {
    ShiningTriangle shining[];
};

layout(push_constant) uniform Push {
    LampPush push;
};

const float kPi = 3.14159265;

// Share of light that passes along unit `direction` up to `to`.
float passing(vec3 origin, vec3 direction, float to) {
    const float kNothing = 1.17549435e-38;
    return transmittance(TracedRay(origin, direction, 0.0), to, kNothing);
}

// Position of a light relative to a receiver, and its unoccluded light there.
struct SeenLight {
    vec3 towards;   // unit
    float distance; // metres, kFar for directional lights
    float share;    // share of its intensity
    float half_angle;
    float weight; // approximate luminance of the irradiance
};

SeenLight see_light(PunctualLight light, LampReceiver receiver) {
    SeenLight seen;
    float reach; // sine of the angle by which a light below the horizon is partly visible
    if (light.directional != 0u) {
        seen.towards = -light.direction;
        seen.distance = kFar;
        seen.share = 1.0;
        seen.half_angle = 0.0;
        reach = 0.0;
    } else {
        vec3 to = light.position - receiver.position.xyz;
        seen.distance = length(to);
        float near = max(seen.distance, max(push.radius, push.nearest));
        seen.towards = seen.distance > 0.0 ? to / seen.distance : receiver.normal.xyz;
        seen.share = share_in_cone(-dot(light.direction, seen.towards), light.inner_cosine, light.outer_cosine) *
                     share_in_range(seen.distance * light.inverse_range) / (near * near);
        seen.half_angle = push.radius < seen.distance ? asin(push.radius / seen.distance)
                          : push.radius > 0.0         ? 0.5 * kPi
                                                      : 0.0;
        reach = push.radius / near;
    }
    float cosine = dot(receiver.normal.xyz, seen.towards);
    seen.weight = dot(light.intensity, vec3(0.2126, 0.7152, 0.0722)) * seen.share * clamp(cosine + reach, 0.0, 1.0);
    return seen;
}

// Returns direction `i` of `count` about the axis of a disc, distributed evenly over its solid angle, and in
// w 1 minus its cosine to the axis; equal to prt::DiscDirections. `rotation` rotates the directions, as a share
// of the circle times 2^32.
vec4 disc_direction(mat3 frame, float depth, uint i, uint count, uint rotation) {
    float below = depth * (float(i) + 0.5) / float(count);
    float sine = sqrt(below * (2.0 - below)), angle = 2.0 * kPi * unit_number(rotation + i * 1640531527u);
    return vec4(normalize(frame * vec3(sine * cos(angle), sine * sin(angle), 1.0 - below)), below);
}

// Sum of the cosines of rays [begin, end) of `count` to a light, each multiplied by its transmittance.
float arriving(SeenLight light, LampReceiver receiver, uvec3 begin_end_count, uint seed) {
    mat3 frame = tangent_frame(light.towards);
    float half_sine = sin(0.5 * light.half_angle), depth = 2.0 * half_sine * half_sine, sum = 0.0;
    for (uint i = begin_end_count.x; i < begin_end_count.y; ++i) {
        vec4 towards = disc_direction(frame, depth, i, begin_end_count.z, seed);
        float cosine = dot(receiver.normal.xyz, towards.xyz);
        if (cosine > 0.0) {
            float to = light.distance;
            if (light.distance < kFar && push.radius > 0.0)
                to = distance_to_sphere(light.distance, towards.w, push.radius);
            sum += cosine * passing(receiver.origin.xyz, towards.xyz, to);
        }
    }
    return sum / (float(begin_end_count.z) * (1.0 - 0.5 * depth)); // mean cosine of the disc
}

// Irradiance from punctual lights: one ray per light, or for lights with an extent a number of rays in
// proportion to their share of the light here.
vec4 light_of_lights(LampReceiver receiver, uint seed) {
    float all = 0.0;
    for (uint i = push.first_light; i < push.end_light; ++i)
        all += see_light(lights[i], receiver).weight;
    vec4 sum = vec4(0.0);
    uint before = 0u; // rays to the previous lights
    for (uint i = push.first_light; i < push.end_light; ++i) {
        SeenLight light = see_light(lights[i], receiver);
        uint rays = 0u;
        if (light.weight > 0.0)
            rays = light.half_angle > 0.0 ? rays_of_share(push.max_rays, light.weight / all) : 1u;
        uint begin = clamp(push.first_ray, before, before + rays) - before;
        uint end = clamp(push.end_ray, before, before + rays) - before;
        if (begin < end) {
            float share = light.share * arriving(light, receiver, uvec3(begin, end, rays), seed);
            sum += vec4(share * lights[i].intensity, float(end - begin));
        }
        before += rays;
    }
    return sum;
}

SeenTriangle see_shining(ShiningTriangle t, LampReceiver receiver) {
    vec3 from = receiver.origin.xyz;
    return see_triangle(t.a - from, t.b - from, t.c - from, t.b - t.a, t.c - t.a, receiver.normal.xyz,
                        t.two_sided != 0u);
}

// Irradiance from a sample of a triangle, as if there were no other triangles.
vec3 irradiance_along(LampReceiver receiver, ShiningTriangle t, SeenTriangle seen, vec2 u) {
    TrianglePoint point = point_of(seen, u);
    float cosine = dot(receiver.normal.xyz, normalize(point.position));
    vec3 result = vec3(0.0);
    if (cosine > 0.0) {
        // The ray ends on the visible side, not on the triangle itself.
        vec3 outward = normalize(seen.volume > 0.0 ? -seen.normal : seen.normal);
        vec3 way = point.position + (t.offset + PRT_LENGTH_OFFSET * length(point.position)) * outward;
        float distance = length(way);
        float share = passing(receiver.origin.xyz, way / distance, distance) * cosine * point.angle / seen.angle;
        if (kAlpha)
            share *= coverage(t.alpha, point.uv, 0.0);
        if (share > 0.0)
            result = share * emission(t, point.uv);
    }
    return result;
}

// Irradiance from emissive triangles. Rays are distributed over the triangles in order, in proportion to mean
// luminance times solid angle.
vec4 light_of_triangles(LampReceiver receiver, uint seed) {
    float all = 0.0;
    uint last = push.end_triangle;
    for (uint i = push.first_triangle; i < push.end_triangle; ++i) {
        float weight = shining[i].luminance * see_shining(shining[i], receiver).angle;
        all += weight;
        last = weight > 0.0 ? i : last;
    }
    vec4 sum = vec4(0.0);
    float before = 0.0;
    uint ray = push.first_ray, end = min(push.end_ray, push.max_rays);
    for (uint i = push.first_triangle; i < push.end_triangle; ++i) {
        SeenTriangle seen = see_shining(shining[i], receiver);
        float weight = shining[i].luminance * seen.angle, until = before + weight;
        bool running = weight > 0.0 && ray < end;
        while (running) {
            float target = all * ((float(ray) + unit_number(seed)) / float(push.max_rays));
            running = target < until || i == last; // independent of the rounding of the sum
            if (running) {
                vec2 u = vec2(clamp((target - before) / weight, 0.0, 1.0), golden(ray, seed * 2654435761u));
                float weight = all / (shining[i].luminance * float(push.max_rays));
                sum += vec4(weight * irradiance_along(receiver, shining[i], seen, u), 1.0);
                ++ray;
                running = ray < end;
            }
        }
        before = until;
    }
    cut_short = cut_short || (all > 0.0 && ray < end);
    return sum;
}

void main() {
    uint p = push.first_receiver + gl_GlobalInvocationID.x;
    if (p >= push.receivers)
        return;
    LampReceiver receiver = receivers[p];
    uint seed = pcg_hash(floatBitsToUint(receiver.origin.w) ^ push.scramble);
    vec4 sum = light_of_lights(receiver, seed) + light_of_triangles(receiver, seed);
    if (cut_short)
        sum.w = uintBitsToFloat(0x7fc00000u); // NaN: the result is invalid
    sums[p] = push.first_ray == 0u ? sum : sums[p] + sum;
}
