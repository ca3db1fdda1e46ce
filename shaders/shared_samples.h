// Hashes for samples that are equal in the baker's GLSL and C++.
#ifndef PRT_SHARED_SAMPLES_H
#define PRT_SHARED_SAMPLES_H

#include "shared_types.h"

#ifdef __cplusplus
namespace prt::glsl {
#endif

// A well-mixed 32-bit hash (Jarzynski and Olano 2020, pcg).
PRT_FUNCTION uint pcg_hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

// Owen's scrambling of a bit-reversed point, by the hash of Laine and Karras (2011) in the form of Vegdahl (2021).
PRT_FUNCTION uint laine_karras(uint v, uint seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

#ifdef __cplusplus
} // namespace prt::glsl
#endif

#endif
