// Structs that the baker's GLSL and C++ share, laid out as in std430: what one side packs the other unpacks by the
// functions and numbers here. C++ includes it through bake/trace/gpu/gpu_structs.h, which has the types of GLSL.
#ifndef PRT_SHARED_STRUCTS_H
#define PRT_SHARED_STRUCTS_H

#include "shared_bake.h"

struct Receiver {
    vec4 origin; // of its rays, off the surface; w: seed of its samples, as bits
    vec4 normal;
};

// Which rays of which receivers a dispatch traces.
struct TracePush {
    uint receivers;
    uint first_chunk, chunks;           // of this dispatch
    uint all_chunks, last_rays;         // chunks of a receiver; rays of the last
    uint first_ray;                     // of the sequence
    uint whole_followed, last_followed; // rays to follow, of a whole chunk and the last
    uint hit_room;
    float spread; // that of TracedRay, times the cosine to the normal
};

// What a vector is added to: three sums, and what it is of the weights of each in all.
struct SumRow {
    uint sums[3]; // or PRT_NO_SUM
    float shares[3];
    float sign; // with which it goes to the signed sums, too
};
#define PRT_NO_SUM 0xffffffffu

// Which rows of a block a dispatch gathers.
struct GatherPush {
    uint first_row, end_row; // of the block
    uint first_gathered;     // where row 0 of the block is written
    uint add;                // whether to the total, too
    uint first_sum_row;      // of row 0 of the block
    float largest;           // of the values of exit transfer, where rows are summed
};
struct EnergyPush {
    uint first, end; // vectors
    uint place;      // of the energies
};

// A receiver that lamps shine on.
struct LampReceiver {
    vec4 origin; // of its rays, off the surface; w: its index, as bits
    vec4 normal;
    vec4 position;
};

// Which rays to a lamp a dispatch traces.
struct LampPush {
    uint first_receiver, receivers;                            // of this dispatch; of all that are bound
    uint first_light, end_light, first_triangle, end_triangle; // of the lamp
    uint scramble;                                             // of its samples
    uint most_rays;                                            // to all of the lamp that has extent
    uint first_ray, end_ray;                                   // of this dispatch
    float radius;                                              // of points and spots, metres
    float nearest;                                             // that a point counts as, metres
};

// A light of KHR_lights_punctual.
struct PunctualLight {
    vec3 intensity; // irradiance at one metre, or at all where directional
    uint directional;
    vec3 position;
    float inverse_range;              // 0: without end
    vec3 direction;                   // unit, the way that it shines
    float inner_cosine, outer_cosine; // of a spot; both below -1 where it is none
    uint unused[3];
};

// A triangle that shines.
struct ShiningTriangle {
    vec3 a;          // corners
    float luminance; // mean
    vec3 b;
    float offset; // that takes the end of a short ray off it, metres; a ray of length d needs PRT_LENGTH_OFFSET d more
    vec3 c;
    uint two_sided;
    vec3 radiance;    // times the texel
    uint alpha;       // place in the alpha table, counting from 1; 0: opaque
    vec2 texcoord[3]; // transformed
    uint image;       // of EmissionImage, or PRT_NO_TEXELS
    uint unused;
};

// The finest level of a texture of radiance.
struct EmissionImage {
    uint texels; // where it begins among the texels, red in the lowest byte
    int width, height;
    uint wrap;   // PRT_WRAPS(of u, of v)
    uint linear; // holds numbers; else colors by the sRGB curve
};

// A surface that a ray met.
struct HitRecord {
    uint triangle; // in the scene's order, or PRT_NO_HIT; PRT_HIT_BACK: met from behind
    float u, v, weight, footprint;
    uint row; // chunk of a receiver
};
#define PRT_NO_HIT 0xffffffffu
#define PRT_HIT_BACK 0x80000000u

// Where a thread is among its rays.
struct ThreadProgress {
    uint ray;      // that it is at, counting from 1; 0: not begun
    float t, left; // distance on the way, and share of the ray
};

// A direction that depth maps are drawn for.
struct Direction {
    vec4 towards_light;
    mat4 map_from_world; // to [0, 1]³
    float basis[PRT_MOST_COEFFICIENTS];
};

// A triangle that does not stop all light.
struct AlphaTriangle {
    vec2 texcoord[3]; // transformed
    float vertex_alpha[3];
    uint material;
    float texel_density; // texels of level 0 per m²
    uint next;           // layer of the same triangle, counting from 1; 0: none
};

struct AlphaMaterial {
    uint mode; // PRT_ALPHA_*; from PRT_ALPHA_BLEND on rays are stopped in part
    float cutoff, factor;
    uint texels; // where level 0 begins among the texels, in bytes, or PRT_NO_TEXELS
    int width, height, levels;
    uint wrap; // PRT_WRAPS(of u, of v)
};
#define PRT_NO_TEXELS 0xffffffffu
#define PRT_WRAPS(u, v) ((u) | (v) << 8)
#define PRT_WRAP_U(wraps) ((wraps)&255u)
#define PRT_WRAP_V(wraps) ((wraps) >> 8)

// A node of the wide hierarchy (bake/trace/gpu/wide_bvh.h): boxes of up to eight children, in slots. They are
// origin + q · step, rounded outwards. Slots are ordered by octant, so that a ray finds near ones first.
struct WideNode {
    vec3 origin;
    uint exponents;      // of the step, eight bits an axis, biased by 127, as in a float
    uint first_child;    // node index of the first inner child
    uint first_triangle; // of the leaves' triangles
    uvec2 meta;          // a byte a slot: 0 empty, PRT_NODE_INNER(i), or PRT_NODE_LEAF(count, first)
    uvec2 low[3];        // [axis], a byte a slot
    uvec2 high[3];
};
// Child i of the inner ones; `count` triangles from first_triangle + first on.
#define PRT_NODE_INNER(i) (0x80u | (i))
#define PRT_NODE_LEAF(count, first) ((count) << 5 | (first))
#define PRT_IS_INNER(meta) (((meta)&0x80u) != 0u)
#define PRT_LEAF_COUNT(meta) ((meta) >> 5)
#define PRT_LEAF_FIRST(meta) ((meta)&31u)

PRT_FUNCTION uvec2 with_byte(uvec2 bytes, uint slot, uint value) {
    uint shifted = value << (8u * (slot & 3u));
    return slot < 4u ? uvec2(bytes.x | shifted, bytes.y) : uvec2(bytes.x, bytes.y | shifted);
}

// The step of an axis, as bits of a float.
PRT_FUNCTION uint step_bits(uint exponents, uint axis) {
    return (exponents >> (8u * axis) & 255u) << 23;
}

#endif
