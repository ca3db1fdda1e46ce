// Geometry and samples of lamps (docs/math.md, section 13). GLSL computes them in float and C++ in double:
// `real` is either type.
#ifndef PRT_SHARED_LAMPS_H
#define PRT_SHARED_LAMPS_H

#include "shared_types.h"

#ifdef __cplusplus
namespace prt::lamp_geometry {
using namespace glsl_double;
#endif

// Returns a number in [0, 1) with 24 bits, which float and double represent exactly.
PRT_LAMP_FUNCTION real unit_number(uint bits) {
    return real(bits >> 8) * (1.0 / 16777216.0);
}

// Returns element i of a sequence in [0, 1) that is uniform for any length: steps of the golden ratio, times
// 2^32.
PRT_LAMP_FUNCTION real golden(uint i, uint begin) {
    return unit_number(begin + i * 2654435769u);
}

// Number of `most` rays for a light with this share of the total: rounded up, but without the rounding error
// of the share itself, so that a single light has `most` rays independent of the device's division.
PRT_LAMP_FUNCTION uint rays_of_share(uint most, real share) {
    return max(1u, uint(ceil(real(most) * (share * (1.0 - 1e-6)))));
}

// Share of its intensity that a spot emits in a direction with this cosine to its axis, as recommended by
// KHR_lights_punctual.
PRT_LAMP_FUNCTION real share_in_cone(real cosine, real inner_cosine, real outer_cosine) {
    real share = clamp((cosine - outer_cosine) / max(0.001, inner_cosine - outer_cosine), 0.0, 1.0);
    return share * share;
}

// Attenuation in addition to the inverse square at this distance over the range, as recommended by
// KHR_lights_punctual.
PRT_LAMP_FUNCTION real share_in_range(real ratio) {
    return clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
}

// Distance to a sphere with its center at distance `middle`, along a direction for which `depth` is 1 minus
// the cosine to the center; 0 inside the sphere.
PRT_LAMP_FUNCTION real distance_to_sphere(real middle, real depth, real radius) {
    if (middle <= radius)
        return 0.0;
    real across = middle * middle * (depth * (2.0 - depth));
    return middle * (1.0 - depth) - sqrt(max(0.0, radius * radius - across));
}

// A triangle relative to the origin.
struct SeenTriangle {
    vec3 a, b, c; // corners
    vec3 ab, ac;  // sides, with less rounding than differences of distant corners
    vec3 normal;  // cross product of the sides
    real volume;  // six times the volume between the origin and the triangle; negative if the front is visible
    real angle;   // solid angle
};

// Solid angle by A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983. `volume` as in
// SeenTriangle.
PRT_LAMP_FUNCTION real solid_angle(vec3 a, vec3 b, vec3 c, real volume) {
    real la = length(a), lb = length(b), lc = length(c);
    real below = 1.0 + dot(a, b) / (la * lb) + dot(a, c) / (la * lc) + dot(b, c) / (lb * lc);
    return volume != 0.0 ? 2.0 * atan(abs(volume) / (la * lb * lc), below) : 0.0;
}

// Creates a SeenTriangle. The angle is 0 if the triangle is below the horizon of `up`, or if its back is
// visible, unless `both_sides` are emissive. The distance of the plane is computed from the nearest corner,
// which has the smallest rounding.
PRT_LAMP_FUNCTION SeenTriangle see_triangle(vec3 a, vec3 b, vec3 c, vec3 ab, vec3 ac, vec3 up, bool both_sides) {
    SeenTriangle t;
    t.a = a;
    t.b = b;
    t.c = c;
    t.ab = ab;
    t.ac = ac;
    t.normal = cross(ab, ac);
    real aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
    vec3 nearer = aa < bb ? a : b;
    t.volume = dot(min(aa, bb) < cc ? nearer : c, t.normal);
    t.angle = 0.0;
    // Most triangles of a closed shape show their back, which is quick to test.
    bool above = max(dot(a, up), max(dot(b, up), dot(c, up))) > 0.0;
    if (above && (both_sides || t.volume < 0.0))
        t.angle = solid_angle(a, b, c, t.volume);
    return t;
}

// Returns the unit direction for `u` in [0, 1]² of a uniform map to the spherical triangle: the map of J.
// Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995, with the point between a and c computed
// as by C. Peters ("BRDF Importance Sampling for Polygons", SIGGRAPH 2021), which avoids cancellation for
// small triangles.
PRT_LAMP_FUNCTION vec3 direction_in(SeenTriangle t, vec2 u) {
    real la = length(t.a), lb = length(t.b), lc = length(t.c);
    vec3 a = t.a / la, b = t.b / lb, c = t.c / lc, ab = a + b;
    real volume = abs(t.volume) / (la * lb * lc);
    real term = 0.5 * u.x * t.angle;
    vec3 middle = (volume * cos(term) - dot(ab, c) * sin(term)) * a + (0.5 * dot(ab, ab) * sin(term)) * c;
    vec3 cut = 2.0 * dot(a, normalize(middle)) * normalize(middle) - a; // between a and c
    vec3 across = cut - dot(cut, b) * b;
    real depth = u.y * 0.5 * dot(b - cut, b - cut); // 1 minus the cosine to b
    return normalize((1.0 - depth) * b + sqrt(depth * max(0.0, 2.0 - depth)) * normalize(across));
}

// A sampled point of an emissive triangle.
struct TrianglePoint {
    vec3 position;
    vec2 uv;    // barycentric coordinates of b and c
    real angle; // solid angle that the point represents
};

// Samples uniformly over the solid angle, or over the area if the solid angle is so small that both are
// equal.
PRT_LAMP_FUNCTION TrianglePoint point_of(SeenTriangle t, vec2 u) {
    TrianglePoint p;
    if (t.angle < 1e-3) {
        real root = sqrt(u.x);
        p.uv = vec2(root * (1.0 - u.y), root * u.y);
        p.position = t.a + p.uv.x * t.ab + p.uv.y * t.ac;
        real distance = length(p.position);
        p.angle = 0.5 * abs(t.volume) / (distance * distance * distance);
        return p;
    }
    vec3 direction = direction_in(t, u);
    p.position = t.volume / dot(direction, t.normal) * direction;
    vec3 inside = p.position - t.a;
    real square = dot(t.normal, t.normal);
    p.uv = clamp(vec2(dot(cross(inside, t.ac), t.normal), dot(cross(t.ab, inside), t.normal)) / square, vec2(0.0),
                 vec2(1.0));
    p.angle = t.angle;
    return p;
}

#ifdef __cplusplus
} // namespace prt::lamp_geometry
#endif

#endif
