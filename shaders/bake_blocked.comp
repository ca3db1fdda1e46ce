#version 460
#extension GL_GOOGLE_include_directive : require

// Counts the blocked rays of a chunk, which the hits of followed rays represent (bake_trace.comp). If none of
// the blocked rays was followed, follows one of them. One thread per row.

#include "bake_kernel.glsl"
#include "bake_chunk.glsl"

layout(local_size_x = PRT_BEAM * PRT_BEAMS) in;

layout(std430, binding = PRT_BINDING_BLOCKED) readonly buffer Blocked {
    uint blocked[];
};
layout(std430, binding = PRT_BINDING_BLOCKED_RAYS) writeonly buffer BlockedRays {
    uint blocked_rays[]; // [rows]
};

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= push.receivers * push.chunks)
        return;
    uint receiver = row / push.chunks;
    Chunk c = chunk_of(receiver, push.first_chunk + row - receiver * push.chunks);
    uint all = 0u, followed = 0u, first = c.count;
    for (uint lane = 0u; lane < uint(PRT_BEAM); ++lane) {
        uint mask = blocked[row * uint(PRT_BEAM) + lane];
        uint own = c.followed > lane ? (c.followed - lane + uint(PRT_BEAM) - 1u) / uint(PRT_BEAM) : 0u;
        all += uint(bitCount(mask));
        followed += uint(bitCount(own >= 32u ? mask : mask & (1u << own) - 1u));
        if (mask != 0u)
            first = min(first, uint(findLSB(mask)) * uint(PRT_BEAM) + lane);
    }
    blocked_rays[row] = all;
    HitRecord another = HitRecord(PRT_NO_HIT, 0.0, 0.0, 0.0, 0.0, row);
    if (followed == 0u && all > 0u) {
        RayHit hit;
        aim(c, first);
        if (nearest(c.ray, 0.0, kFar, hit))
            another = record_of(c, hit, 1.0);
    }
    hits[row * (push.whole_followed + 1u) + push.whole_followed] = another;
}
