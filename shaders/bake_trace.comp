#version 460
#extension GL_GOOGLE_include_directive : require

// Traces rays of receivers (docs/math.md, eq. 9): the blocked share of each ray, and with kHits its hits. A
// thread traces every 32nd ray of a chunk, so that adjacent threads trace a narrow beam.

#include "bake_kernel.glsl"
#include "bake_chunk.glsl"

layout(local_size_x = PRT_BEAM, local_size_y = PRT_BEAMS) in;
layout(constant_id = PRT_CONSTANT_HITS) const bool kHits = false;

layout(std430, binding = PRT_BINDING_BLOCKED) buffer Blocked {
    uint blocked[]; // [rows][PRT_BEAM]: bit k of thread i is ray 32 k + i
};
layout(std430, binding = PRT_BINDING_SHARES) writeonly buffer Shares {
    float shares[]; // [rows][PRT_CHUNK] blocked share of each ray, if kAlpha
};
layout(std430, binding = PRT_BINDING_HIT_COUNT) buffer HitCount {
    uint hit_count;       // if kAlpha: hits beyond the capacity were not recorded, and their threads stopped
    uint loops_cut_short; // not 0: all results are invalid
};
layout(std430, binding = PRT_BINDING_PROGRESS) buffer Threads {
    ThreadProgress threads[]; // [rows][PRT_BEAM], if kAlpha
};

// Returns a mask of the blocked rays.
uint trace_visibility(Chunk c, uint lane) {
    uint mask = 0u, i = lane;
    for (; i < c.count; i += uint(PRT_BEAM)) {
        aim(c, i);
        float share = 1.0 - transmittance(c.ray, kFar, PRT_MIN_TRANSMITTANCE);
        if (kAlpha)
            shares[c.row * uint(PRT_CHUNK) + i] = share;
        mask |= share > 0.0 ? 1u << (i / uint(PRT_BEAM)) : 0u;
    }
    cut_short = cut_short || i < c.count;
    return mask;
}

// Returns a mask of the blocked rays of an opaque scene, and records hits of the followed rays.
uint trace_some_hits(Chunk c, uint lane) {
    uint mask = 0u, slots = c.row * (push.whole_followed + 1u), i = lane;
    for (; i < c.count; i += uint(PRT_BEAM)) {
        aim(c, i);
        bool found;
        if (i < c.followed) {
            RayHit hit;
            found = nearest(c.ray, 0.0, kFar, hit);
            hits[slots + i] = found ? record_of(c, hit, 1.0) : HitRecord(PRT_NO_HIT, 0.0, 0.0, 0.0, 0.0, 0u);
        } else {
            found = transmittance(c.ray, kFar, PRT_MIN_TRANSMITTANCE) == 0.0;
        }
        mask |= found ? 1u << (i / uint(PRT_BEAM)) : 0u;
    }
    cut_short = cut_short || i < c.count;
    return mask;
}

// Follows rays through surfaces that transmit a share of them. A thread stops if there is no space for a hit,
// and continues in the next dispatch.
uint trace_through(Chunk c, uint lane) {
    uint position = c.row * uint(PRT_BEAM) + lane;
    ThreadProgress at = threads[position];
    bool begun = at.ray > 0u;
    uint mask = begun ? blocked[position] : 0u, i = begun ? at.ray - 1u : lane;
    float left = begun ? at.left : 1.0, t = begun ? at.t : 0.0;
    bool running = i < c.count;
    while (running) {
        aim(c, i);
        bool passing = true;
        while (passing) {
            RayHit hit;
            passing = nearest(c.ray, t, kFar, hit);
            if (passing) {
                float passes = left * (1.0 - hit.covered);
                passes = passes < PRT_MIN_TRANSMITTANCE ? 0.0 : passes;
                uint slot = atomicAdd(hit_count, 1u);
                running = slot < push.hit_room;
                if (running) {
                    hits[slot] = record_of(c, hit, left - passes);
                    left = passes;
                    t = behind(hit.t);
                }
                passing = running && left > 0.0;
            }
        }
        cut_short = cut_short || passing;
        if (running) {
            shares[c.row * uint(PRT_CHUNK) + i] = 1.0 - left;
            mask |= left < 1.0 ? 1u << (i / uint(PRT_BEAM)) : 0u;
            i += uint(PRT_BEAM);
            left = 1.0;
            t = 0.0;
            running = i < c.count;
        }
    }
    cut_short = cut_short || running;
    threads[position] = ThreadProgress(i + 1u, t, left);
    return mask;
}

void main() {
    uint lane = gl_LocalInvocationID.x, receiver = gl_WorkGroupID.x * uint(PRT_BEAMS) + gl_LocalInvocationID.y;
    if (receiver >= push.receivers)
        return;
    Chunk c = chunk_of(receiver, push.first_chunk + gl_WorkGroupID.y);
    uint mask = !kHits ? trace_visibility(c, lane) : kAlpha ? trace_through(c, lane) : trace_some_hits(c, lane);
    blocked[c.row * uint(PRT_BEAM) + lane] = mask;
    if (cut_short)
        loops_cut_short = 1u;
}
