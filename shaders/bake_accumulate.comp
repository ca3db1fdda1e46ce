#version 460
#extension GL_GOOGLE_include_directive : require

// Sums over the rays of a receiver that bake_trace.comp traced (docs/math.md, eq. 9): each chunk sums the
// spherical harmonics of its blocked rays or of its open rays, whichever are fewer. One workgroup per
// receiver; each thread sums its own rays in registers.

#include "bake_kernel.glsl"
#include "bake_samples.glsl"
#include "bake_sums.glsl"

layout(constant_id = PRT_CONSTANT_ORDER) const int kOrder = 6;
layout(constant_id = PRT_CONSTANT_SUBGROUPS) const uint kSubgroups = 8; // maximum subgroups of a workgroup

layout(local_size_x = PRT_BEAM) in;

layout(std430, binding = PRT_BINDING_RECEIVERS) readonly buffer Receivers {
    Receiver receivers[];
};
layout(std430, binding = PRT_BINDING_SUMS) buffer Sums {
    // Per receiver: sum of open minus blocked rays, [order²], and the number of rays that use the control
    // variate; if kSummed the first coefficients of the vector, [kFirst].
    float sums[];
};
layout(std430, binding = PRT_BINDING_SIGNED_SUMS) buffer SignedSums {
    int signed_sums[]; // [sums][order²] the sums with signs
};
layout(std430, binding = PRT_BINDING_BLOCKED) readonly buffer Blocked {
    uint blocked[];
};
layout(std430, binding = PRT_BINDING_SHARES) readonly buffer Shares {
    float shares[];
};
layout(std430, binding = PRT_BINDING_SH_FACTORS) readonly buffer ShFactors {
    vec4 sh_factors[PRT_MAX_COEFFICIENTS]; // at PRT_SH_FACTOR(l, m): a_lm, b_lm, sectoral factor (l = m), lobe factor
};
layout(push_constant) uniform Push {
    TracePush push;
};

const int kCoefficients = kOrder * kOrder;
const uint kFirst = uint(kCoefficients < PRT_FIRST_COEFFICIENTS ? kCoefficients : PRT_FIRST_COEFFICIENTS);
shared float partial[kSubgroups * uint(kCoefficients)];
shared float partial_blocked[kSubgroups];

// In registers: every index into it is known at compile time.
float total[PRT_MAX_COEFFICIENTS];

#define PRT_BANDS_FROM(m, STEP)                                                                                        \
    STEP(m, 0) STEP(m, 1) STEP(m, 2) STEP(m, 3) STEP(m, 4) STEP(m, 5) STEP(m, 6) STEP(m, 7) STEP(m, 8) STEP(m, 9)
#define PRT_EVERY_DEGREE(WORK) WORK(0) WORK(1) WORK(2) WORK(3) WORK(4) WORK(5) WORK(6) WORK(7) WORK(8) WORK(9)

// Computes band l of degree m by recurrence from the previous bands (docs/math.md, eq. 3); for a lobe times
// its factor.
#define PRT_ADD_BAND(m, l)                                                                                             \
    if (l >= m && l < kOrder) {                                                                                        \
        vec4 factors = sh_factors[PRT_SH_FACTOR(l, m)];                                                                \
        float next = l == m ? factors.z : factors.x * (d.z * legendre) - factors.y * before;                           \
        before = l == m ? 0.0 : legendre;                                                                              \
        legendre = next;                                                                                               \
        float value = lobe ? legendre * factors.w : legendre;                                                          \
        total[l * (l + 1) + m] += value * cosine;                                                                      \
        if (m > 0)                                                                                                     \
            total[max(l * (l + 1) - m, 0)] += value * sine;                                                            \
    }
#define PRT_ADD_DEGREE(m)                                                                                              \
    if (m < kOrder) {                                                                                                  \
        float before = 0.0, legendre = 0.0;                                                                            \
        PRT_BANDS_FROM(m, PRT_ADD_BAND)                                                                                \
        float rotated = d.x * cosine - d.y * sine;                                                                     \
        sine = d.x * sine + d.y * cosine;                                                                              \
        cosine = rotated;                                                                                              \
    }

// Adds weight times the basis to `total`, or weight times the clamped cosine lobe.
void add_basis(vec3 d, float weight, const bool lobe) {
    float cosine = weight, sine = 0.0;
    PRT_EVERY_DEGREE(PRT_ADD_DEGREE)
}

#define PRT_CLEAR_BAND(m, l)                                                                                           \
    if (l >= m && l < kOrder)                                                                                          \
        total[l * (l + 1) + m] = total[max(l * (l + 1) - m, 0)] = 0.0;
#define PRT_CLEAR_DEGREE(m) PRT_BANDS_FROM(m, PRT_CLEAR_BAND)

// Writes the subgroup's sum of a coefficient to `partial`.
#define PRT_SUM(k)                                                                                                     \
    {                                                                                                                  \
        float sum = subgroupAdd(total[k]);                                                                             \
        if (subgroupElect())                                                                                           \
            partial[gl_SubgroupID * uint(kCoefficients) + uint(k)] = sum;                                              \
    }
#define PRT_SUM_BAND(m, l)                                                                                             \
    if (l >= m && l < kOrder) {                                                                                        \
        PRT_SUM(l*(l + 1) + m)                                                                                         \
        if (m > 0)                                                                                                     \
            PRT_SUM(max(l*(l + 1) - m, 0))                                                                             \
    }
#define PRT_SUM_DEGREE(m) PRT_BANDS_FROM(m, PRT_SUM_BAND)

// Returns the sum over the workgroup.
float sum_of_group(float mine) {
    float sum = subgroupAdd(mine);
    if (gl_NumSubgroups > 1u) {
        if (subgroupElect())
            partial_blocked[gl_SubgroupID] = sum;
        barrier();
        sum = 0.0;
        for (uint i = 0u; i < gl_NumSubgroups; ++i)
            sum += partial_blocked[i];
        barrier();
    }
    return sum;
}

// Adds a coefficient of this part of the receiver's rays.
void add_to_sums(uint receiver, uint k, float coefficient) {
    SumRow row = sum_rows[receiver];
    for (uint i = 0u; i < 3u; ++i)
        if (row.sums[i] != PRT_NO_SUM) {
            int value = fixed_point(row.shares[i] * coefficient);
            uint position = row.sums[i] * uint(kCoefficients) + k;
            atomicAdd(fixed_sums[position], value);
            atomicAdd(signed_sums[position], row.sign < 0.0 ? -value : value);
        }
    if (k < kFirst)
        sums[receiver * kFirst + k] += coefficient;
}

void main() {
    uint receiver = gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    uint seed = floatBitsToUint(receivers[receiver].origin.w);
    mat3 frame = tangent_frame(receivers[receiver].normal.xyz);
    PRT_EVERY_DEGREE(PRT_CLEAR_DEGREE)
    float control = 0.0;
    for (uint c = 0u; c < push.chunks; ++c) {
        uint chunk = push.first_chunk + c, row = receiver * push.chunks + c;
        bool last = chunk + 1u == push.all_chunks;
        uint count = last ? push.last_rays : uint(PRT_CHUNK), table = last ? uint(PRT_CHUNK) : 0u;
        uvec2 offset = sobol_offset(push.first_ray + chunk * uint(PRT_CHUNK));
        uint mask = blocked[row * uint(PRT_BEAM) + lane];
        float mine = float(bitCount(mask));
        if (kAlpha) {
            mine = 0.0;
            for (uint i = lane; i < count; i += uint(PRT_BEAM))
                mine += shares[row * uint(PRT_CHUNK) + i];
        }
        float all = sum_of_group(mine);
        bool mostly_open = 2.0 * all <= float(count);
        control += mostly_open ? float(count) : 0.0;
        uint own = count > lane ? (count - lane + uint(PRT_BEAM) - 1u) / uint(PRT_BEAM) : 0u; // rays of this thread
        uint present = own >= 32u ? ~0u : (1u << own) - 1u;
        uint wanted = mostly_open ? mask : kAlpha ? present : present & ~mask;
        while (wanted != 0u) {
            uint k = uint(findLSB(wanted)), i = k * uint(PRT_BEAM) + lane;
            wanted &= wanted - 1u;
            float share = kAlpha ? shares[row * uint(PRT_CHUNK) + i] : mostly_open ? 1.0 : 0.0;
            add_basis(ray_direction(sobol[table + i] ^ offset, seed, frame), mostly_open ? -share : 1.0 - share, false);
        }
    }
    if (kSummed && lane == 0u)
        add_basis(receivers[receiver].normal.xyz, control, true);
    PRT_EVERY_DEGREE(PRT_SUM_DEGREE)
    barrier();
    float rays = float((push.all_chunks - 1u) * uint(PRT_CHUNK) + push.last_rays);
    uint first = receiver * uint(kCoefficients + 1);
    for (uint k = lane; k < uint(kCoefficients); k += uint(PRT_BEAM)) {
        float sum = 0.0;
        for (uint i = 0u; i < gl_NumSubgroups; ++i)
            sum += partial[i * uint(kCoefficients) + k];
        if (kSummed)
            add_to_sums(receiver, k, sum / rays);
        else
            sums[first + k] += sum;
    }
    if (!kSummed && lane == 0u)
        sums[first + uint(kCoefficients)] += control;
}
