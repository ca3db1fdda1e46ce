// Geometry and samples of lamps (docs/math.md, section 13), which the baker's GLSL computes in float and its C++ in
// double: `real` is either. C++ includes it through bake/lamps/lamp_geometry.h.
#ifndef PRT_SHARED_LAMPS_H
#define PRT_SHARED_LAMPS_H

#ifdef __cplusplus
#define PRT_LAMP_FUNCTION inline
#else
#define PRT_LAMP_FUNCTION
#define real float
#endif

// A number in [0, 1) of 24 bits, which float and double both hold.
PRT_LAMP_FUNCTION real unit_number(uint bits) {
    return real(bits >> 8) * (1.0 / 16777216.0);
}

// Even steps of a sequence in [0, 1) that stays even wherever it ends: by the golden ratio, of 2^32.
PRT_LAMP_FUNCTION real golden(uint i, uint begin) {
    return unit_number(begin + i * 2654435769u);
}

// Rays of `most` that go to a light which gives that share of all: rounded up, but not by what rounding of the share
// itself adds, so that a light alone has `most` however a device divides.
PRT_LAMP_FUNCTION uint rays_of_share(uint most, real share) {
    return max(1u, uint(ceil(real(most) * (share * (1.0 - 1e-6)))));
}

// Share of its intensity that a spot sends along a direction of this cosine to its middle, as KHR_lights_punctual
// recommends.
PRT_LAMP_FUNCTION real share_in_cone(real cosine, real inner_cosine, real outer_cosine) {
    real share = clamp((cosine - outer_cosine) / max(0.001, inner_cosine - outer_cosine), 0.0, 1.0);
    return share * share;
}

// What is left of an inverse square at this distance over the range, as KHR_lights_punctual recommends.
PRT_LAMP_FUNCTION real share_in_range(real ratio) {
    return clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
}

// Distance to a sphere whose middle is so far away, along a direction of which `depth` is 1 less the cosine to the
// middle; 0 within it.
PRT_LAMP_FUNCTION real distance_to_sphere(real middle, real depth, real radius) {
    if (middle <= radius)
        return 0.0;
    real across = middle * middle * (depth * (2.0 - depth));
    return middle * (1.0 - depth) - sqrt(max(0.0, radius * radius - across));
}

// A triangle as it is seen from the origin.
struct SeenTriangle {
    vec3 a, b, c; // corners
    vec3 ab, ac;  // sides, rounded less than the differences of far corners are
    vec3 normal;  // cross product of the sides
    real volume;  // six times that between the origin and the triangle; negative where the front is seen
    real angle;   // solid angle
};

// A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983. `volume` is that of SeenTriangle.
PRT_LAMP_FUNCTION real solid_angle(vec3 a, vec3 b, vec3 c, real volume) {
    real la = length(a), lb = length(b), lc = length(c);
    real below = 1.0 + dot(a, b) / (la * lb) + dot(a, c) / (la * lc) + dot(b, c) / (lb * lc);
    return volume != 0.0 ? 2.0 * atan(abs(volume) / (la * lb * lc), below) : 0.0;
}

// The angle is 0 where all of it is below the horizon of `up`, and where its back is seen, unless `both_sides` shine.
// The plane's distance is taken from the nearest corner, whose rounding is the least.
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
    // Most triangles of a closed shape show their back, which is quick to tell.
    bool above = max(dot(a, up), max(dot(b, up), dot(c, up))) > 0.0;
    if (above && (both_sides || t.volume < 0.0))
        t.angle = solid_angle(a, b, c, t.volume);
    return t;
}

// The unit direction at `u` in [0, 1]² of an even map onto the spherical triangle: that of J. Arvo, "Stratified
// Sampling of Spherical Triangles", SIGGRAPH 1995, with the point between a and c found as C. Peters does ("BRDF
// Importance Sampling for Polygons", SIGGRAPH 2021), where little cancels however small the triangle is.
PRT_LAMP_FUNCTION vec3 direction_in(SeenTriangle t, vec2 u) {
    real la = length(t.a), lb = length(t.b), lc = length(t.c);
    vec3 a = t.a / la, b = t.b / lb, c = t.c / lc, ab = a + b;
    real volume = abs(t.volume) / (la * lb * lc);
    real part = 0.5 * u.x * t.angle;
    vec3 middle = (volume * cos(part) - dot(ab, c) * sin(part)) * a + (0.5 * dot(ab, ab) * sin(part)) * c;
    vec3 cut = 2.0 * dot(a, normalize(middle)) * normalize(middle) - a; // between a and c
    vec3 across = cut - dot(cut, b) * b;
    real depth = u.y * 0.5 * dot(b - cut, b - cut); // 1 less the cosine to b
    return normalize((1.0 - depth) * b + sqrt(depth * max(0.0, 2.0 - depth)) * normalize(across));
}

// A point of a triangle that shines, as sampled.
struct TrianglePoint {
    vec3 place;
    vec2 uv;    // barycentric coordinates of b and c
    real angle; // solid angle that it stands for
};

// Even over the solid angle, or where that is so small that there is no difference, over the area.
PRT_LAMP_FUNCTION TrianglePoint point_of(SeenTriangle t, vec2 u) {
    TrianglePoint p;
    if (t.angle < 1e-3) {
        real root = sqrt(u.x);
        p.uv = vec2(root * (1.0 - u.y), root * u.y);
        p.place = t.a + p.uv.x * t.ab + p.uv.y * t.ac;
        real distance = length(p.place);
        p.angle = 0.5 * abs(t.volume) / (distance * distance * distance);
        return p;
    }
    vec3 direction = direction_in(t, u);
    p.place = t.volume / dot(direction, t.normal) * direction;
    vec3 inside = p.place - t.a;
    real square = dot(t.normal, t.normal);
    p.uv = clamp(vec2(dot(cross(inside, t.ac), t.normal), dot(cross(t.ab, inside), t.normal)) / square, vec2(0.0),
                 vec2(1.0));
    p.angle = t.angle;
    return p;
}

#endif
