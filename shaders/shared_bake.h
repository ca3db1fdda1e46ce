// Numbers that the baker shares between GLSL and C++.
#ifndef PRT_SHARED_BAKE_H
#define PRT_SHARED_BAKE_H

#include "shared_layout.h"

// Offset of rays from a surface, relative to the lengths of the triangle and of the ray that ends there
// (docs/math.md, section 2): 16 roundings of a float.
#define PRT_LENGTH_OFFSET 9.5367431640625e-7f

// Storage buffers.
#define PRT_BINDING_NODES 1
#define PRT_BINDING_CORNERS 2
#define PRT_BINDING_SAMPLES 3
#define PRT_BINDING_DIRECTIONS 3 // depth maps use neither samples nor the hits below
#define PRT_BINDING_RECEIVERS 4
#define PRT_BINDING_SUMS 5
#define PRT_BINDING_HITS 6
#define PRT_BINDING_HIT_COUNT 7
#define PRT_BINDING_BLOCKED 8
#define PRT_BINDING_TOUCHING 6
#define PRT_BINDING_TOUCHING_RANGES 7
#define PRT_BINDING_PASSES 8
#define PRT_BINDING_PUNCTUAL_LIGHTS 3 // lamps use neither samples nor hits
#define PRT_BINDING_SHINING_TRIANGLES 6
#define PRT_BINDING_EMISSION_IMAGES 7
#define PRT_BINDING_EMISSION_TEXELS 8
#define PRT_BINDING_ALPHA_TRIANGLES 9
#define PRT_BINDING_ALPHA_MATERIALS 10
#define PRT_BINDING_ALPHA_TEXELS 11
#define PRT_BINDING_SHARES 12
#define PRT_BINDING_SH_FACTORS 13
#define PRT_BINDING_PROGRESS 14
#define PRT_BINDING_BLOCKED_RAYS 15
#define PRT_BINDING_INSTANCES 16
#define PRT_BINDING_SUM_ROWS 17
#define PRT_BINDING_FIXED_SUMS 18
#define PRT_BINDING_SIGNED_SUMS 19
// Storage buffers of the gather.
#define PRT_BINDING_ROW_ENDS 1
#define PRT_BINDING_SOURCES 2
#define PRT_BINDING_WEIGHTS 3
#define PRT_BINDING_REFLECTANCE 4
#define PRT_BINDING_EXIT 5
#define PRT_BINDING_GATHERED 6
#define PRT_BINDING_TOTAL 7
#define PRT_BINDING_ENERGY 8
// Specialisation constants.
#define PRT_CONSTANT_ALPHA 0
#define PRT_CONSTANT_TEXTURED 1
#define PRT_CONSTANT_HITS 2
#define PRT_CONSTANT_ORDER 3
#define PRT_CONSTANT_SUBGROUPS 4
#define PRT_CONSTANT_STACK 5
#define PRT_CONSTANT_OPAQUE 6
#define PRT_CONSTANT_CHANNELS 7
#define PRT_CONSTANT_ROW_THREADS 8
#define PRT_CONSTANT_SHARED 9
#define PRT_CONSTANT_SUMMED 10
// Texture units.
#define PRT_UNIT_OPAQUE_DEPTH 2
#define PRT_UNIT_LAST_DEPTH 3
#define PRT_UNIT_LAYER_COVERAGE 4

// Surfaces: a mode in addition to prt::AlphaMode, and prt::Wrap.
#define PRT_ALPHA_GLASS 3
#define PRT_WRAP_REPEAT 0
#define PRT_WRAP_MIRROR 1
#define PRT_WRAP_CLAMP 2

// Spherical harmonics, and the index of the recurrence factors of band l and degree m.
#define PRT_MAX_ORDER 10
#define PRT_MAX_COEFFICIENTS (PRT_MAX_ORDER * PRT_MAX_ORDER)
#define PRT_SH_FACTOR(l, m) (PRT_MAX_ORDER * (l) + (m))

// A ray with a smaller remaining share ends at the surface it hits.
#define PRT_MIN_TRANSMITTANCE (1.0 / 1024.0)

// Rays that are generated together, threads that trace them, and number of such beams per workgroup.
#define PRT_CHUNK 1024
#define PRT_BEAM 32
#define PRT_BEAMS 2
// Sums of vectors in fixed point: the value of 1, and the upper limit of a sum and of all its addends.
#define PRT_FIXED_ONE 536870912.0
#define PRT_FIXED_LIMIT 3.9
// Threads of a workgroup of the gather.
#define PRT_GATHER_THREADS 64
// Coefficients of a vector that are returned if vectors are summed: three bands.
#define PRT_FIRST_COEFFICIENTS 9
// Receivers of a workgroup whose rays to lamps are traced together.
#define PRT_LAMP_THREADS 64

#endif
