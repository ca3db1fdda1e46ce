// Direct transfer of receivers by rays (docs/math.md, eq. 9): one workgroup a receiver. The workgroup traces a
// chunk of rays, decides whether the blocked or the open ones are fewer, and sums their spherical harmonics on
// chip. With PRT_HITS it also notes what some of the rays, or with PRT_ALPHA all of them, meet.

#include "shared_bake.h"
#include "shared_structs.h"
#include "bake_samples.glsl"
#include "bake_bvh.glsl"
#include "bake_sh.glsl"
#ifdef PRT_ALPHA
#include "bake_alpha.glsl"
#endif

layout(local_size_x = PRT_TRACE_THREADS) in;

layout(std430, binding = PRT_BINDING_RECEIVERS) readonly buffer Receivers {
    Receiver receivers[];
};
layout(std430, binding = PRT_BINDING_SUMS) buffer Sums {
    float sums[]; // per receiver: sum of open minus blocked, [order²], and the rays that use the control variate
};
#ifdef PRT_HITS
layout(std430, binding = PRT_BINDING_HITS) writeonly buffer Hits {
    HitRecord hits[];
};
layout(std430, binding = PRT_BINDING_HIT_COUNT) buffer HitCount {
    uint hit_count;
};
layout(std430, binding = PRT_BINDING_BLOCKED) writeonly buffer Blocked {
    float blocked_of[]; // [receivers][chunks of this dispatch]
};
uniform uint hit_capacity;
#endif

uniform uint first_ray, first_chunk, end_chunk, all_chunks, last_rays; // chunks of this dispatch; rays of the last
uniform uint whole_followed, last_followed;                            // rays to follow, of a whole chunk and the last
uniform float rays;                                                    // of a receiver, for the footprint

shared float blocked[PRT_CHUNK];
shared float terms[PRT_TRACE_THREADS * PRT_COEFFICIENTS];
shared float partial[PRT_TRACE_THREADS];
shared uint followed_hits;

// Points of the sequence are linear over GF(2): point (first + j) is point j XOR point `first`.
uvec2 sobol_offset(uint first) {
    uint column = 1u, y = 0u, index = first;
    while (index != 0u) {
        if ((index & 1u) != 0u)
            y ^= column;
        column ^= column << 1;
        index >>= 1;
    }
    return uvec2(first, y);
}

#ifdef PRT_HITS
void note_hit(uint receiver, uint chunk, BvhHit hit, float weight, float footprint) {
    uint slot = atomicAdd(hit_count, 1u);
    atomicAdd(followed_hits, 1u);
    if (slot < hit_capacity)
        hits[slot] = HitRecord(receiver, chunk, hit.triangle | (hit.back ? PRT_HIT_BACK : 0u), hit.uv.x, hit.uv.y,
                               weight, footprint, 0u);
}
#endif

float footprint_of(BvhHit hit, vec3 direction, vec3 normal) {
    vec3 a = corners[3u * hit.slot].xyz;
    vec3 face = cross(corners[3u * hit.slot + 1u].xyz - a, corners[3u * hit.slot + 2u].xyz - a);
    return 3.14159265 * hit.t * hit.t * length(face) / (rays * dot(normal, direction) * abs(dot(face, direction)));
}

// Share of the ray that is blocked. `follow`: note what it meets.
float trace(vec3 origin, vec3 normal, vec3 direction, uint receiver, uint chunk, bool follow) {
    BvhHit hit;
#ifdef PRT_ALPHA
    float left = 1.0, t = 0.0;
    bool running = true;
    while (running) {
        running = trace_ray(origin, direction, t, kFar, false, hit);
        if (running) {
            float footprint = footprint_of(hit, direction, normal);
            uint alpha = floatBitsToUint(corners[3u * hit.slot + 1u].w);
            float passes = left * (1.0 - coverage(alpha, hit.uv, footprint));
            passes = passes < PRT_LEAST_TRANSMITTANCE ? 0.0 : passes;
#ifdef PRT_HITS
            if (left > passes)
                note_hit(receiver, chunk, hit, left - passes, footprint);
#endif
            left = passes;
            t = behind(hit.t);
            running = left > 0.0;
        }
    }
    return 1.0 - left;
#else
    bool found = trace_ray(origin, direction, 0.0, kFar, !follow, hit);
#ifdef PRT_HITS
    if (found && follow)
        note_hit(receiver, chunk, hit, 1.0, footprint_of(hit, direction, normal));
#endif
    return found ? 1.0 : 0.0;
#endif
}

// Writes weight times the basis to `terms` at `first`.
void write_basis(vec3 d, float weight, int first) {
    float cosine = weight, sine = 0.0;
    for (int m = 0; m < PRT_ORDER; ++m) {
        float before = 0.0, legendre = sh_factors[PRT_SH_FACTOR(m, m)].z;
        for (int l = m; l < PRT_ORDER; ++l) {
            if (l > m) {
                vec4 factors = sh_factors[PRT_SH_FACTOR(l, m)];
                float next = factors.x * (d.z * legendre) - factors.y * before;
                before = legendre;
                legendre = next;
            }
            terms[first + l * (l + 1) + m] = legendre * cosine;
            if (m > 0)
                terms[first + l * (l + 1) - m] = legendre * sine;
        }
        float turned = d.x * cosine - d.y * sine;
        sine = d.x * sine + d.y * cosine;
        cosine = turned;
    }
}

void main() {
    uint receiver = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    vec3 origin = receivers[receiver].origin.xyz, normal = receivers[receiver].normal.xyz;
    uint seed = floatBitsToUint(receivers[receiver].origin.w);
    mat3 frame = tangent_frame(normal);
    const uint kPerThread = (PRT_COEFFICIENTS + PRT_TRACE_THREADS - 1) / PRT_TRACE_THREADS;
    float total[kPerThread];
    for (uint i = 0u; i < kPerThread; ++i)
        total[i] = 0.0;
    float control = 0.0;

    for (uint chunk = first_chunk; chunk < end_chunk; ++chunk) {
        bool last = chunk + 1u == all_chunks;
        uint count = last ? last_rays : uint(PRT_CHUNK), table = last ? uint(PRT_CHUNK) : 0u;
        uint followed = last ? last_followed : whole_followed;
        uvec2 offset = sobol_offset(first_ray + chunk * uint(PRT_CHUNK));
        if (thread == 0u)
            followed_hits = 0u;
        barrier();

        float mine = 0.0;
        for (uint i = thread; i < count; i += uint(PRT_TRACE_THREADS)) {
            vec3 direction = ray_direction(sobol[table + i] ^ offset, seed, frame);
            float share = trace(origin, normal, direction, receiver, chunk, i < followed);
            blocked[i] = share;
            mine += share;
        }
        partial[thread] = mine;
        barrier();
        float all_blocked = 0.0;
        for (uint i = 0u; i < uint(PRT_TRACE_THREADS); ++i)
            all_blocked += partial[i];
#ifdef PRT_HITS
        // Only rays that were not followed are blocked: one of them is.
        if (thread == 0u && followed_hits == 0u && all_blocked > 0.0) {
            uint i = 0u;
            while (i + 1u < count && blocked[i] == 0.0)
                ++i;
            trace(origin, normal, ray_direction(sobol[table + i] ^ offset, seed, frame), receiver, chunk, true);
        }
        if (thread == 0u)
            blocked_of[receiver * (end_chunk - first_chunk) + chunk - first_chunk] = all_blocked;
#endif

        bool mostly_open = 2.0 * all_blocked <= float(count);
        control += mostly_open ? float(count) : 0.0;
        for (uint begin = 0u; begin < count; begin += uint(PRT_TRACE_THREADS)) {
            // Beams are narrow, so that many groups have nothing to sum: `partial` says whether this one has.
            uint i = begin + thread;
            float weight = 0.0;
            if (i < count)
                weight = mostly_open ? -blocked[i] : 1.0 - blocked[i];
            barrier();
            partial[thread] = abs(weight);
            barrier();
            float any = 0.0;
            for (uint j = 0u; j < uint(PRT_TRACE_THREADS); ++j)
                any += partial[j];
            if (any > 0.0) {
                uint at = min(i, count - 1u);
                write_basis(ray_direction(sobol[table + at] ^ offset, seed, frame), weight,
                            int(thread) * PRT_COEFFICIENTS);
            }
            barrier();
            if (any > 0.0)
                for (uint c = 0u; c < kPerThread; ++c) {
                    uint k = c * uint(PRT_TRACE_THREADS) + thread;
                    if (k < uint(PRT_COEFFICIENTS)) {
                        float sum = 0.0;
                        for (uint j = 0u; j < uint(PRT_TRACE_THREADS); ++j)
                            sum += terms[j * uint(PRT_COEFFICIENTS) + k];
                        total[c] += sum;
                    }
                }
        }
        barrier();
    }
    uint first = receiver * (uint(PRT_COEFFICIENTS) + 1u);
    for (uint c = 0u; c < kPerThread; ++c) {
        uint k = c * uint(PRT_TRACE_THREADS) + thread;
        if (k < uint(PRT_COEFFICIENTS))
            sums[first + k] += total[c];
    }
    if (thread == 0u)
        sums[first + uint(PRT_COEFFICIENTS)] += control;
}
