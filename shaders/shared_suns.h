// Suns and their shadow maps as GLSL and C++ share them, laid out as in std430. C++ includes it through
// runtime/render/gl/sun_structs.h, which has the types of GLSL.
#ifndef PRT_SHARED_SUNS_H
#define PRT_SHARED_SUNS_H

#define PRT_MOST_SUNS 4
#define PRT_MOST_SLICES 4 // of what the camera sees, by distance; each has a map for each sun
#define PRT_MAP_BORDER 2  // texels of a map beyond what it is fitted to

// Storage buffers. Vertices lit by suns read these, since weights may take all attributes.
#define PRT_BINDING_NORMALS 6
#define PRT_BINDING_FACTOR_TEXCOORDS 7
#define PRT_BINDING_TINT_TEXCOORDS 8
#define PRT_BINDING_SUNS 9

// Texture units, beside those of shared_layout.h and shared_viewer.h (0 to 7).
#define PRT_UNIT_SUN_DEPTH 13
#define PRT_UNIT_SUN_LAYERS 8
#define PRT_UNIT_SUN_PASSES 9
#define PRT_UNIT_TRANSMISSION_FACTOR 10
#define PRT_UNIT_TRANSMISSION_TINT 11
#define PRT_UNIT_GLASS 12

#define PRT_LOCATION_GLASS_TEXCOORD 3 // of casters

struct SunLight {
    vec4 towards; // unit; w: tangent of the half angle
    vec4 open;    // exit radiance of a white surface that faces it, nothing in the way
};

// Places in a map are texels, and metres behind its near plane.
struct SunMap {
    vec4 across, up, along; // each gives one from a place seen from the eye, with 1 as its fourth
    vec2 texels_per_metre;
    float depth; // metres from the near plane to the far one
    float texel; // its longer side, metres
};

struct SunsSeen {
    SunLight suns[PRT_MOST_SUNS];
    SunMap maps[PRT_MOST_SUNS * PRT_MOST_SLICES]; // [count][slices]
    vec4 slice_ends;                              // distances along the view, near ones first
    vec4 eye;
    vec4 forward; // of the view, unit
    int count, slices;
    int layered; // something lets a part of the light through
    int unused;
};

#endif
