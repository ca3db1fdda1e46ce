// A chunk of a receiver's rays, and records of its hits.

#include "bake_samples.glsl"
#include "bake_traversal.glsl"

layout(std430, binding = PRT_BINDING_RECEIVERS) readonly buffer Receivers {
    Receiver receivers[];
};
layout(push_constant) uniform Push {
    TracePush push;
};
// Hits: for each row [slots], one slot for every followed ray and one more; if kAlpha in any order. A row is
// a chunk of a receiver.
layout(std430, binding = PRT_BINDING_HITS) writeonly buffer Hits {
    HitRecord hits[];
};

struct Chunk {
    TracedRay ray;
    vec3 normal;
    mat3 frame;
    uvec2 offset;
    uint seed, count, followed, table, row;
};

Chunk chunk_of(uint receiver, uint chunk) {
    Chunk c;
    bool last = chunk + 1u == push.all_chunks;
    c.count = last ? push.last_rays : uint(PRT_CHUNK);
    c.followed = last ? push.last_followed : push.whole_followed;
    c.table = last ? uint(PRT_CHUNK) : 0u;
    c.offset = sobol_offset(push.first_ray + chunk * uint(PRT_CHUNK));
    c.seed = floatBitsToUint(receivers[receiver].origin.w);
    c.normal = receivers[receiver].normal.xyz;
    c.frame = tangent_frame(c.normal);
    c.ray.origin = receivers[receiver].origin.xyz;
    c.ray.spread = 0.0;
    c.row = receiver * push.chunks + chunk - push.first_chunk;
    return c;
}

void aim(inout Chunk c, uint i) {
    c.ray.direction = ray_direction(sobol[c.table + i] ^ c.offset, c.seed, c.frame);
    if (kTextured)
        c.ray.spread = push.spread / dot(c.normal, c.ray.direction);
}

HitRecord record_of(Chunk c, RayHit hit, float weight) {
    return HitRecord(hit.triangle | (hit.back ? PRT_HIT_BACK : 0u), hit.uv.x, hit.uv.y, weight, hit.footprint, c.row);
}
