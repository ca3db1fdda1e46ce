// Suns and their shadow maps, shared between GLSL and C++, with std430 layout.
#ifndef PRT_SHARED_SUNS_H
#define PRT_SHARED_SUNS_H

#include "shared_types.h"

#define PRT_MAX_SUNS 4
#define PRT_MAX_SLICES 4 // slices of the view by distance; each has a map per sun
#define PRT_MAP_BORDER 2 // texels of a map beyond the fitted region

// Storage buffers. Vertices lit by suns read them, because weights may use all attributes.
#define PRT_BINDING_NORMALS 6
#define PRT_BINDING_FACTOR_TEXCOORDS 7
#define PRT_BINDING_TINT_TEXCOORDS 8
#define PRT_BINDING_SUNS 9

// Texture units in addition to those of shared_layout.h and shared_viewer.h (0 to 7).
#define PRT_UNIT_SUN_DEPTH 13
#define PRT_UNIT_SUN_LAYERS 8
#define PRT_UNIT_SUN_PASSES 9
#define PRT_UNIT_TRANSMISSION_FACTOR 10
#define PRT_UNIT_TRANSMISSION_TINT 11
#define PRT_UNIT_GLASS 12

#define PRT_LOCATION_GLASS_TEXCOORD 3 // attribute of casters

#ifdef __cplusplus
namespace prt::suns {
using namespace glsl;
#endif

struct SunLight {
    vec4 towards; // unit; w: tangent of the half angle
    vec4 open;    // exit radiance of an unoccluded white surface that faces the sun
};

// A shadow map. Positions in a map are in texels, and in metres behind its near plane.
struct SunMap {
    vec4 across, up, along; // each maps a position relative to the eye, with 1 as fourth component
    vec2 texels_per_metre;
    float depth; // metres from the near plane to the far plane
    float texel; // the longer side of a texel, metres
};

struct SunsSeen {
    SunLight suns[PRT_MAX_SUNS];
    SunMap maps[PRT_MAX_SUNS * PRT_MAX_SLICES]; // [count][slices]
    vec4 slice_ends;                            // distances along the view, in ascending order
    vec4 eye;
    vec4 forward; // unit view direction
    int count, slices;
    int layered; // some surface transmits a part of the light
    int unused;
};

#ifdef __cplusplus
static_assert(sizeof(SunLight) == 32 && sizeof(SunMap) == 64 && offsetof(SunMap, texels_per_metre) == 48 &&
              offsetof(SunMap, depth) == 56);
static_assert(offsetof(SunsSeen, maps) == 32 * PRT_MAX_SUNS &&
              offsetof(SunsSeen, slice_ends) == (32 + 64 * PRT_MAX_SLICES) * PRT_MAX_SUNS &&
              offsetof(SunsSeen, count) == offsetof(SunsSeen, slice_ends) + 48 &&
              sizeof(SunsSeen) == offsetof(SunsSeen, count) + 16);
} // namespace prt::suns
#endif

#endif
