// Looks up the light of a volume at a position (docs/format.md, "Probes"). For GLSL 4.5 and 3.3,
// GLSL ES 3.0 and Vulkan:
//
//     vec3 prt_volume_irradiance(vec3 position, vec3 normal)
//         Returns irradiance divided by pi. Times the albedo, this is the exit radiance of a surface.
//     float prt_volume_sun_visibility(vec3 position, vec3 normal)
//         Returns the visibility of the sun for which the light texture was computed, 0..1.
//     void prt_volume_incident(vec3 position, vec3 normal, out vec3 light[PRT_VOLUME_COEFFICIENTS])
//         Computes the coefficients of incident light, the argument `light` of the following functions.
//     vec3 prt_incident_irradiance(light, normal)
//         Returns irradiance divided by pi.
//     vec3 prt_incident_radiance(light, towards)
//         Returns blurred radiance from unit direction `towards`, for glossy reflections.
//     vec3 prt_incident_direction(light)
//         Returns the main direction of the light.
//
// `position` is in metres; `normal` is the unit normal of the lit surface, or zero.
//
// Define before including (prt::volume_defines writes the lines for a volume)
//     PRT_VOLUME_ORDER n         order of incident light, 2..4,
//     PRT_VOLUME_LINEAR          if the sampler of light filters linearly; it is then used in cells that all their
//                                probes see,
// and, as numbers or as names of uniforms,
//     PRT_VOLUME_ORIGIN          vec3: minimum corner, in the same frame as positions,
//     PRT_VOLUME_SPACING         float: distance of the finest probes,
//     PRT_VOLUME_SIZE            ivec3: in bricks of level 0,
//     PRT_VOLUME_FIRST           ivec4: position and level of brick 0,
//     PRT_VOLUME_BRICKS          ivec3: size of the atlas in bricks (prt::VolumeAtlas).

#include "shared_layout.h"

#define PRT_VOLUME_COEFFICIENTS (PRT_VOLUME_ORDER * PRT_VOLUME_ORDER)

// If the language has no binding layout, the program must bind samplers by name.
#if defined(VULKAN) || (!defined(GL_ES) && __VERSION__ >= 420)
#define PRT_VOLUME_SAMPLER(number) layout(binding = number) uniform highp
#else
#define PRT_VOLUME_SAMPLER(number) uniform highp
#endif

// Textures as defined in prt/core/transfer_volume.h.
PRT_VOLUME_SAMPLER(PRT_UNIT_VOLUME_LIGHT) sampler3D prt_volume_light;
PRT_VOLUME_SAMPLER(PRT_UNIT_VOLUME_VISIBILITY) usampler3D prt_volume_visibility;
PRT_VOLUME_SAMPLER(PRT_UNIT_VOLUME_INDEX) usampler3D prt_volume_index;

struct PrtVolumeBrick {
    ivec3 position; // in bricks of level 0
    int level, slot;
};

// A position between eight probes.
struct PrtVolumePosition {
    ivec3 texel; // texel of the minimum corner
    vec3 share;  // position in the cell, along each axis
    bool seen;   // visible from all probes: weights are trilinear
    vec4 weights[2];
};

// Returns the brick that contains a position inside the volume, or `brick` if no brick does.
PrtVolumeBrick prt_volume_brick(vec3 position, PrtVolumeBrick brick) {
    vec3 bricks = (position - PRT_VOLUME_ORIGIN) / (4.0 * PRT_VOLUME_SPACING);
    ivec3 point = clamp(ivec3(floor(bricks)), ivec3(0), PRT_VOLUME_SIZE - 1);
    uint entry = texelFetch(prt_volume_index, point, 0).r;
    if (entry != 0xFFFFFFFFu) {
        brick.level = int(entry & 3u);
        brick.slot = int(entry >> 2);
        brick.position = (point >> brick.level) << brick.level;
    }
    return brick;
}

// Returns the visibility weight of a probe for a position at offset `from` from it, in cells. `visibility`:
// its texel.
float prt_volume_probe_weight(uvec2 visibility, vec3 from) {
    vec3 below = vec3(visibility.x & 255u, visibility.x >> 16 & 255u, visibility.y & 255u),
         above = vec3(visibility.x >> 8 & 255u, visibility.x >> 24, visibility.y >> 8 & 255u);
    vec3 root = mix(below, above, greaterThan(from, vec3(0.0))) / 255.0;
    vec3 distances = PRT_VOLUME_VISIBILITY_CELLS * float(1u << (visibility.y >> 16 & 3u)) * root * root;
    vec3 along = abs(from) / max(distances, vec3(1e-18));
    float passed = max(along.x, max(along.y, along.z)); // 1: at the surface
    float behind = clamp(
        (passed - PRT_VOLUME_VISIBILITY_FULL) / (PRT_VOLUME_VISIBILITY_NONE - PRT_VOLUME_VISIBILITY_FULL), 0.0, 1.0);
    float beyond = clamp(passed, 1.0, 16.0), squared = beyond * beyond, fourth = squared * squared;
    return max(1.0 - behind * behind * (3.0 - 2.0 * behind), PRT_VOLUME_HIDDEN_WEIGHT / (fourth * fourth));
}

// Returns the weights of the probes around a position. `at`: position relative to the minimum corner of
// `brick`, in its cells; it may be outside the brick.
PrtVolumePosition prt_volume_weighted(PrtVolumeBrick brick, vec3 at) {
    vec3 inside = clamp(at, vec3(0.0), vec3(4.0));
    ivec3 low = min(ivec3(inside), ivec3(3)), bricks = PRT_VOLUME_BRICKS;
    PrtVolumePosition point;
    point.share = inside - vec3(low);
    point.texel =
        low + 5 * ivec3(brick.slot % bricks.x, brick.slot / bricks.x % bricks.y, brick.slot / (bricks.x * bricks.y));
    uvec2 visibility = texelFetch(prt_volume_visibility, point.texel, 0).rg;
    point.seen = visibility.y >> 24 == 1u && at == inside;
    vec3 over = point.share, under = 1.0 - over;
    vec4 face = vec4(under.x, over.x, under.x, over.x) * vec4(under.y, under.y, over.y, over.y);
    point.weights[0] = face * under.z;
    point.weights[1] = face * over.z;
    if (!point.seen) {
        vec3 from = at - vec3(low);
        for (int i = 0; i < 8; ++i) {
            ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
            visibility = texelFetch(prt_volume_visibility, point.texel + corner, 0).rg;
            point.weights[i >> 2][i & 3] *= prt_volume_probe_weight(visibility, from - vec3(corner));
        }
        float sum = dot(point.weights[0] + point.weights[1], vec4(1.0));
        point.weights[0] /= sum;
        point.weights[1] /= sum;
    }
    return point;
}

PrtVolumePosition prt_volume_find(vec3 position, vec3 normal) {
    vec3 least = PRT_VOLUME_ORIGIN, most = least + 4.0 * PRT_VOLUME_SPACING * vec3(PRT_VOLUME_SIZE);
    vec3 inside = clamp(position, least, most);
    ivec4 first = PRT_VOLUME_FIRST;
    PrtVolumeBrick brick = prt_volume_brick(inside, PrtVolumeBrick(first.xyz, first.w, 0));
    float cell = PRT_VOLUME_SPACING * float(1 << brick.level);
    vec3 seen = clamp(inside + PRT_VOLUME_NORMAL_BIAS * cell * normal, least, most);
    brick = prt_volume_brick(seen, brick);
    cell = PRT_VOLUME_SPACING * float(1 << brick.level);
    return prt_volume_weighted(brick, (seen - (least + PRT_VOLUME_SPACING * vec3(4 * brick.position))) / cell);
}

// Returns the four interpolated numbers of a plane at a position.
vec4 prt_volume_plane(PrtVolumePosition point, int plane) {
    ivec3 texel = point.texel + ivec3(0, 0, 5 * PRT_VOLUME_BRICKS.z * plane);
#ifdef PRT_VOLUME_LINEAR
    if (point.seen) {
        vec3 at = vec3(texel) + point.share + 0.5;
        return textureLod(prt_volume_light, at / vec3(textureSize(prt_volume_light, 0)), 0.0);
    }
#endif
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i)
        sum += point.weights[i >> 2][i & 3] * texelFetch(prt_volume_light, texel + ivec3(i & 1, i >> 1 & 1, i >> 2), 0);
    return sum;
}

void prt_volume_incident(vec3 position, vec3 normal, out vec3 light[PRT_VOLUME_COEFFICIENTS]) {
    const int kPlanes = (3 * PRT_VOLUME_COEFFICIENTS + 3) / 4;
    PrtVolumePosition point = prt_volume_find(position, normal);
    vec4 numbers[kPlanes];
    for (int i = 0; i < kPlanes; ++i)
        numbers[i] = prt_volume_plane(point, i);
    for (int i = 0; i < PRT_VOLUME_COEFFICIENTS; ++i) {
        int n = 3 * i;
        light[i] = vec3(numbers[n >> 2][n & 3], numbers[(n + 1) >> 2][(n + 1) & 3], numbers[(n + 2) >> 2][(n + 2) & 3]);
    }
}

float prt_volume_sun_visibility(vec3 position, vec3 normal) {
    const int kNumber = 3 * PRT_VOLUME_COEFFICIENTS;
    return prt_volume_plane(prt_volume_find(position, normal), kNumber >> 2)[kNumber & 3];
}

// Returns the radiance in unit direction `n` of `light` with band l multiplied by `bands[l]` (docs/math.md,
// eq. 1 to 3).
vec3 prt_incident_sum(vec3 light[PRT_VOLUME_COEFFICIENTS], vec3 n, vec4 bands) {
    vec3 sum = bands[0] * 0.282094792 * light[0];
    sum += bands[1] * 0.488602512 * (-n.y * light[1] + n.z * light[2] - n.x * light[3]);
#if PRT_VOLUME_ORDER > 2
    sum += bands[2] *
           (1.092548431 * (n.x * n.y * light[4] - n.y * n.z * light[5] - n.x * n.z * light[7]) +
            0.315391565 * (3.0 * n.z * n.z - 1.0) * light[6] + 0.546274215 * (n.x * n.x - n.y * n.y) * light[8]);
#endif
#if PRT_VOLUME_ORDER > 3
    vec3 s = n * n;
    sum += bands[3] *
           (-0.590043590 * n.y * (3.0 * s.x - s.y) * light[9] + 2.890611442 * n.x * n.y * n.z * light[10] -
            0.457045799 * n.y * (5.0 * s.z - 1.0) * light[11] + 0.373176333 * n.z * (5.0 * s.z - 3.0) * light[12] -
            0.457045799 * n.x * (5.0 * s.z - 1.0) * light[13] + 1.445305721 * n.z * (s.x - s.y) * light[14] -
            0.590043590 * n.x * (s.x - 3.0 * s.y) * light[15]);
#endif
    return max(sum, vec3(0.0));
}

// Returns irradiance divided by pi. The factors of the clamped cosine are 1, 2/3, 1/4 and 0.
vec3 prt_incident_irradiance(vec3 light[PRT_VOLUME_COEFFICIENTS], vec3 normal) {
    return prt_incident_sum(light, normal, vec4(1.0, 2.0 / 3.0, 0.25, 0.0));
}

vec3 prt_incident_radiance(vec3 light[PRT_VOLUME_COEFFICIENTS], vec3 towards) {
    return prt_incident_sum(light, towards, vec4(1.0));
}

// Returns the unit direction to the maximum of the light; zero if the light is uniform.
vec3 prt_incident_direction(vec3 light[PRT_VOLUME_COEFFICIENTS]) {
    const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 direction = vec3(-dot(light[3], kLuminance), -dot(light[1], kLuminance), dot(light[2], kLuminance));
    float size = length(direction);
    return size > 0.0 ? direction / size : vec3(0.0);
}

vec3 prt_volume_irradiance(vec3 position, vec3 normal) {
    vec3 light[PRT_VOLUME_COEFFICIENTS];
    prt_volume_incident(position, normal, light);
    return prt_incident_irradiance(light, normal);
}
