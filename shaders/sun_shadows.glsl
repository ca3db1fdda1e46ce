// How much of a sun shows at a place, from its shadow map: percentage-closer soft shadows (R. Fernando, SIGGRAPH 2005
// sketch). What blocks is looked for in the cone that the sun fills, and the map is filtered over what that cone is as
// wide as at the mean blocker. Both compare with the plane of the surface, so that a slope does not shadow itself.

#include "sun_view.glsl"

layout(binding = PRT_UNIT_SUN_DEPTH) uniform sampler2DArray sun_depth;
layout(binding = PRT_UNIT_SUN_LAYERS) uniform sampler2DArray sun_layers; // metres: the first, less the last
layout(binding = PRT_UNIT_SUN_PASSES) uniform sampler2DArray sun_passes;

const int kSunSearch = 24, kSunTaps = 32;
// Of a surface that the sun grazes: beyond, a plane that is interpolated from its pixels is not to be trusted.
const float kSteepest = 50.0;

// A plane before a map: a place on it, and metres of depth for each texel.
struct MapPlane {
    int layer;
    vec3 place;
    vec2 slope;
    float bias; // metres
};

MapPlane plane_in_map(int layer, vec3 seen, vec3 face) {
    SunMap map = suns_seen.maps[layer];
    vec3 n = vec3(dot(map.across.xyz, face) / map.texels_per_metre.x, dot(map.up.xyz, face) / map.texels_per_metre.y,
                  dot(map.along.xyz, face));
    vec2 slope = -n.xy / (n.z < 0.0 ? min(n.z, -1e-4) : max(n.z, 1e-4));
    slope *= min(1.0, kSteepest / max(length(slope), 1e-6));
    // Two texels off the surface a roof under whose edge a wall ends still covers all that the filter reaches. What
    // blocks is told from the surface halfway there.
    vec2 aside = (n.z < 0.0 ? 2.0 : -2.0) * map.texel * n.xy;
    vec3 place = place_in_map(map, seen) + vec3(aside * map.texels_per_metre, dot(aside, slope));
    float bias = map.texel * length(vec3(slope, 1.0)) + 2e-6 * map.depth; // and the rounding of floats
    return MapPlane(layer, place, slope / map.texels_per_metre, bias);
}

// The middle of a texel near the plane's place, from there, in texels.
vec2 from_place(MapPlane plane, ivec2 texel) {
    return vec2(texel) + 0.5 - plane.place.xy;
}
float plane_depth(MapPlane plane, ivec2 texel) {
    return plane.place.z + dot(plane.slope, from_place(plane, texel)) - plane.bias;
}

// Point i of so many, evenly over the unit disc (H. Vogel 1979).
vec2 disc_point(int i, int count, float turn) {
    float angle = turn + 2.39996323 * float(i);
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

ivec2 texel_at(MapPlane plane, vec2 offset) {
    return clamp(ivec2(floor(plane.place.xy + offset)), ivec2(0), textureSize(sun_depth, 0).xy - 1);
}

// Nothing is as far as the far plane: it lies behind all that is seen, but not behind planes that go on.
float blocker_depth(MapPlane plane, ivec2 texel) {
    float depth = texelFetch(sun_depth, ivec3(texel, plane.layer), 0).r;
    return depth < 1.0 ? depth * suns_seen.maps[plane.layer].depth : 1e30;
}

// Of what lets a part through: none before the first layer, all behind the last; between them as if they were spread
// evenly.
float passed_layers(ivec3 at, float depth) {
    vec2 layers = texelFetch(sun_layers, at, 0).rg;
    float first = layers.x, last = -layers.y;
    float share = depth <= first ? 0.0 : depth >= last ? 1.0 : (depth - first) / (last - first);
    return share == 0.0 ? 1.0 : pow(texelFetch(sun_passes, at, 0).r, share);
}

// Metres from the place to what blocks on average; negative: nothing does.
float mean_blocker_distance(MapPlane plane, float tangent, float turn) {
    SunMap map = suns_seen.maps[plane.layer];
    float reach = tangent * plane.place.z; // at the near plane
    vec2 radius = reach * map.texels_per_metre + 1.5;
    float sum = 0.0, found = 0.0;
    for (int i = 0; i < kSunSearch; ++i) {
        // Dense about the middle: near the place the cone is narrow.
        float share = (float(i) + 0.5) / float(kSunSearch);
        ivec2 texel = texel_at(plane, radius * share * disc_point(i, kSunSearch, turn));
        float limit = plane_depth(plane, texel), depth = blocker_depth(plane, texel);
        if (suns_seen.layered != 0)
            depth = min(depth, texelFetch(sun_layers, ivec3(texel, plane.layer), 0).r);
        float away = plane.place.z - depth;
        bool in_cone =
            length(from_place(plane, texel) / map.texels_per_metre) <= tangent * max(away, 0.0) + 1.5 * map.texel;
        if (depth < limit && in_cone) {
            sum += max(away, 0.0);
            found += 1.0;
        }
    }
    return found > 0.0 ? sum / found : -1.0;
}

// Share of a sun's light that arrives. `seen`: from the eye; `face`: unit normal of the triangle.
float sun_visibility(int sun, vec3 seen, vec3 face) {
    int slice = 0;
    float distance_along = dot(seen, suns_seen.forward.xyz);
    for (int i = 0; i < suns_seen.slices - 1; ++i)
        slice += distance_along > suns_seen.slice_ends[i] ? 1 : 0;
    MapPlane plane = plane_in_map(sun * suns_seen.slices + slice, seen, face);
    // Patterns of neighbouring pixels are turned against each other (J. Jimenez, SIGGRAPH 2014 course).
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
