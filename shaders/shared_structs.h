// Structs that the baker shares between GLSL and C++, with std430 layout: one side packs them and the other
// unpacks them with the functions and numbers of this file. bake/trace_gpu/struct_layout.cpp checks the layout.
#ifndef PRT_SHARED_STRUCTS_H
#define PRT_SHARED_STRUCTS_H

#include "shared_bake.h"
#include "shared_types.h"

#ifdef __cplusplus
namespace prt::gpu {
using namespace glsl;
#endif

struct Receiver {
    vec4 origin; // origin of its rays, off the surface; w: seed of its samples, as bits
    vec4 normal;
};

// Selects the rays and receivers that a dispatch traces.
struct TracePush {
    uint receivers;
    uint first_chunk, chunks;           // chunks of this dispatch
    uint all_chunks, last_rays;         // chunks per receiver; rays of the last one
    uint first_ray;                     // first ray of the sequence
    uint whole_followed, last_followed; // followed rays of a whole chunk and of the last one
    uint hit_room;
    float spread; // spread of TracedRay, times the cosine to the normal
};

// Sums that a vector is added to, with its share of the total weight of each.
struct SumRow {
    uint sums[3]; // indices of sums, or PRT_NO_SUM
    float shares[3];
    float sign; // factor of the vector in the signed sums
};
#define PRT_NO_SUM 0xffffffffu

// Selects the rows of a block that a dispatch gathers.
struct GatherPush {
    uint first_row, end_row; // rows of the block
    uint first_gathered;     // row at which row 0 of the block is written
    uint add;                // also add to the total
    uint first_sum_row;      // sum row of row 0 of the block
    float largest;           // maximum of exit transfer, if rows are summed
};
struct EnergyPush {
    uint first, end; // vectors
    uint position;   // index of the energy
};

// A receiver that is lit by lamps.
struct LampReceiver {
    vec4 origin; // origin of its rays, off the surface; w: its index, as bits
    vec4 normal;
    vec4 position;
};

// Selects the rays to a lamp that a dispatch traces.
struct LampPush {
    uint first_receiver, receivers;                            // first receiver of this dispatch; number of
                                                               // bound receivers
    uint first_light, end_light, first_triangle, end_triangle; // ranges of the lamp
    uint scramble;                                             // scramble of its samples
    uint max_rays;                                             // rays to all parts of the lamp that have an extent
    uint first_ray, end_ray;                                   // ray range of this dispatch
    float radius;                                              // radius of points and spots, metres
    float nearest;                                             // minimum distance of a point light, metres
};

// A light of KHR_lights_punctual.
struct PunctualLight {
    vec3 intensity; // irradiance at one metre, or everywhere if directional
    uint directional;
    vec3 position;
    float inverse_range;              // 0: infinite range
    vec3 direction;                   // unit, direction of the light
    float inner_cosine, outer_cosine; // cone of a spot; both below -1 for other lights
    uint unused[3];
};

// An emissive triangle.
struct ShiningTriangle {
    vec3 a;          // corners
    float luminance; // mean
    vec3 b;
    float offset; // offset of the end of a short ray, metres; a ray of length d needs PRT_LENGTH_OFFSET d in addition
    vec3 c;
    uint two_sided;
    vec3 radiance;    // multiplied by the texel
    uint alpha;       // index in the alpha table, counting from 1; 0: opaque
    vec2 texcoord[3]; // transformed
    uint image;       // index of an EmissionImage, or PRT_NO_TEXELS
    uint unused;
};

// The finest level of an emission texture.
struct EmissionImage {
    uint texels; // index of its first texel, red in the lowest byte
    int width, height;
    uint wrap;   // PRT_WRAPS(wrap of u, wrap of v)
    uint linear; // 1: linear values; 0: colors with the sRGB curve
};

// A surface that a ray hit.
struct HitRecord {
    uint triangle; // index in the scene, or PRT_NO_HIT; PRT_HIT_BACK: hit from behind
    float u, v, weight, footprint;
    uint row; // chunk of a receiver
};
#define PRT_NO_HIT 0xffffffffu
#define PRT_HIT_BACK 0x80000000u

// Progress of a thread in its rays.
struct ThreadProgress {
    uint ray;      // current ray, counting from 1; 0: not started
    float t, left; // distance along the ray, and remaining share of the ray
};

// A direction with a depth map.
struct Direction {
    vec4 towards_light;
    mat4 map_from_world; // to [0, 1]³
    float basis[PRT_MAX_COEFFICIENTS];
};

// A triangle that does not stop all light.
struct AlphaTriangle {
    vec2 texcoord[3]; // transformed
    float vertex_alpha[3];
    uint material;
    float texel_density; // texels of level 0 per m²
    uint next;           // next layer of the same triangle, counting from 1; 0: none
};

struct AlphaMaterial {
    uint mode; // PRT_ALPHA_*; from PRT_ALPHA_BLEND on rays are stopped partially
    float cutoff, factor;
    uint texels; // byte index of the first texel of level 0, or PRT_NO_TEXELS
    int width, height, levels;
    uint wrap; // PRT_WRAPS(wrap of u, wrap of v)
};
#define PRT_NO_TEXELS 0xffffffffu
#define PRT_WRAPS(u, v) ((u) | (v) << 8)
#define PRT_WRAP_U(wraps) ((wraps)&255u)
#define PRT_WRAP_V(wraps) ((wraps) >> 8)

// A node of the wide hierarchy (bake/trace_gpu/wide_bvh.h): boxes of up to eight children, in slots. Corners
// of a box are origin + q · step, rounded outwards. Slots are ordered by octant, so that a ray visits near
// children first.
struct WideNode {
    vec3 origin;
    uint exponents;      // exponents of the step, eight bits per axis, biased by 127, as in a float
    uint first_child;    // node index of the first inner child
    uint first_triangle; // index of the first triangle of the leaves
    uvec2 meta;          // one byte per slot: 0 empty, PRT_NODE_INNER(i), or PRT_NODE_LEAF(count, first)
    uvec2 low[3];        // [axis] one byte per slot
    uvec2 high[3];
};
// Inner child i; `count` triangles from first_triangle + first on.
#define PRT_NODE_INNER(i) (0x80u | (i))
#define PRT_NODE_LEAF(count, first) ((count) << 5 | (first))
#define PRT_IS_INNER(meta) (((meta)&0x80u) != 0u)
#define PRT_LEAF_COUNT(meta) ((meta) >> 5)
#define PRT_LEAF_FIRST(meta) ((meta)&31u)

PRT_FUNCTION uvec2 with_byte(uvec2 bytes, uint slot, uint value) {
    uint shifted = value << (8u * (slot & 3u));
    return slot < 4u ? uvec2(bytes.x | shifted, bytes.y) : uvec2(bytes.x, bytes.y | shifted);
}

// Returns the step of an axis as bits of a float.
PRT_FUNCTION uint step_bits(uint exponents, uint axis) {
    return (exponents >> (8u * axis) & 255u) << 23;
}

#ifdef __cplusplus
} // namespace prt::gpu
#endif

#endif
