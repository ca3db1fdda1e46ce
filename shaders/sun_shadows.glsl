// Visibility of a sun at a position, from its shadow map: percentage-closer soft shadows (R. Fernando,
// SIGGRAPH 2005 sketch). Searches blockers in the cone that the sun fills, and filters the map over the width
// of the cone at the mean blocker. Both compare with the plane of the surface, so that a slope does not
// shadow itself.

#include "sun_view.glsl"

layout(binding = PRT_UNIT_SUN_DEPTH) uniform sampler2DArray sun_depth;
layout(binding = PRT_UNIT_SUN_LAYERS) uniform sampler2DArray sun_layers; // metres: the first layer, minus the last
layout(binding = PRT_UNIT_SUN_PASSES) uniform sampler2DArray sun_passes;

const int kSunSearch = 24, kSunTaps = 32;
// Maximum slope of a surface at grazing angles: above it, a plane interpolated from pixels is unreliable.
const float kSteepest = 50.0;

// A plane in a map: a point on it, and its depth change in metres per texel.
struct MapPlane {
    int layer;
    vec3 position;
    vec2 slope;
    float bias; // metres
};

MapPlane plane_in_map(int layer, vec3 seen, vec3 face) {
    SunMap map = suns_seen.maps[layer];
    vec3 n = vec3(dot(map.across.xyz, face) / map.texels_per_metre.x, dot(map.up.xyz, face) / map.texels_per_metre.y,
                  dot(map.along.xyz, face));
    vec2 slope = -n.xy / (n.z < 0.0 ? min(n.z, -1e-4) : max(n.z, 1e-4));
    slope *= min(1.0, kSteepest / max(length(slope), 1e-6));
    // Move two texels off the surface: a roof whose edge is above the end of a wall then still covers the
    // whole filter. Blockers are separated from the surface at half this distance.
    vec2 aside = (n.z < 0.0 ? 2.0 : -2.0) * map.texel * n.xy;
    vec3 position = position_in_map(map, seen) + vec3(aside * map.texels_per_metre, dot(aside, slope));
    float bias = map.texel * length(vec3(slope, 1.0)) + 2e-6 * map.depth; // including float rounding
    return MapPlane(layer, position, slope / map.texels_per_metre, bias);
}

// Vector from the plane's point to the center of a texel, in texels.
vec2 from_position(MapPlane plane, ivec2 texel) {
    return vec2(texel) + 0.5 - plane.position.xy;
}
float plane_depth(MapPlane plane, ivec2 texel) {
    return plane.position.z + dot(plane.slope, from_position(plane, texel)) - plane.bias;
}

// Point i of `count`, evenly over the unit disc (H. Vogel 1979).
vec2 disc_point(int i, int count, float turn) {
    float angle = turn + 2.39996323 * float(i);
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

ivec2 texel_at(MapPlane plane, vec2 offset) {
    return clamp(ivec2(floor(plane.position.xy + offset)), ivec2(0), textureSize(sun_depth, 0).xy - 1);
}

// Depth of the blocker in a texel. An empty texel has the depth of the far plane, which is behind all visible
// points, but not behind extrapolated planes, so it counts as infinite.
float blocker_depth(MapPlane plane, ivec2 texel) {
    float depth = texelFetch(sun_depth, ivec3(texel, plane.layer), 0).r;
    return depth < 1.0 ? depth * suns_seen.maps[plane.layer].depth : 1e30;
}

// Transmittance of partial blockers: all light before the first layer, that of all layers behind the last; in
// between the layers are assumed to be distributed evenly.
float passed_layers(ivec3 at, float depth) {
    vec2 layers = texelFetch(sun_layers, at, 0).rg;
    float first = layers.x, last = -layers.y;
    float share = depth <= first ? 0.0 : depth >= last ? 1.0 : (depth - first) / (last - first);
    return share == 0.0 ? 1.0 : pow(texelFetch(sun_passes, at, 0).r, share);
}

// Mean distance from the point to its blockers in metres; negative: there are none.
float mean_blocker_distance(MapPlane plane, float tangent, float turn) {
    SunMap map = suns_seen.maps[plane.layer];
    float reach = tangent * plane.position.z; // at the near plane
    vec2 radius = reach * map.texels_per_metre + 1.5;
    float sum = 0.0, found = 0.0;
    for (int i = 0; i < kSunSearch; ++i) {
        // Denser at the center, because the cone is narrow near the point.
        float share = (float(i) + 0.5) / float(kSunSearch);
        ivec2 texel = texel_at(plane, radius * share * disc_point(i, kSunSearch, turn));
        float limit = plane_depth(plane, texel), depth = blocker_depth(plane, texel);
        if (suns_seen.layered != 0)
            depth = min(depth, texelFetch(sun_layers, ivec3(texel, plane.layer), 0).r);
        float away = plane.position.z - depth;
        bool in_cone =
            length(from_position(plane, texel) / map.texels_per_metre) <= tangent * max(away, 0.0) + 1.5 * map.texel;
        if (depth < limit && in_cone) {
            sum += max(away, 0.0);
            found += 1.0;
        }
    }
    return found > 0.0 ? sum / found : -1.0;
}

// Share of a sun's light that arrives. `seen`: position relative to the eye; `face`: unit normal of the
// triangle.
float sun_visibility(int sun, vec3 seen, vec3 face) {
    int slice = 0;
    float distance_along = dot(seen, suns_seen.forward.xyz);
    for (int i = 0; i < suns_seen.slices - 1; ++i)
        slice += distance_along > suns_seen.slice_ends[i] ? 1 : 0;
    MapPlane plane = plane_in_map(sun * suns_seen.slices + slice, seen, face);
    // The patterns of adjacent pixels are rotated relative to each other (J. Jimenez, SIGGRAPH 2014 course).
    float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    float tangent = suns_seen.suns[sun].towards.w, away = mean_blocker_distance(plane, tangent, turn);
    if (away < 0.0)
        return 1.0;
    vec2 radius = max(tangent * away * suns_seen.maps[plane.layer].texels_per_metre, vec2(0.75));
    float open = 0.0;
    for (int i = 0; i < kSunTaps; ++i) {
        ivec2 texel = texel_at(plane, radius * disc_point(i, kSunTaps, turn));
        float limit = plane_depth(plane, texel);
        if (blocker_depth(plane, texel) >= limit)
            open += suns_seen.layered != 0 ? passed_layers(ivec3(texel, plane.layer), limit) : 1.0;
    }
    return open / float(kSunTaps);
}
