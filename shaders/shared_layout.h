// Numbers that GLSL and C++ share. Included by both: plain preprocessor only.
#ifndef PRT_SHARED_LAYOUT_H
#define PRT_SHARED_LAYOUT_H

// Vertex attribute locations.
#define PRT_LOCATION_POSITION 0
#define PRT_LOCATION_TEXCOORD 1
#define PRT_LOCATION_COLOR 2
#define PRT_LOCATION_RADIANCE 3 // shares its place with the cluster: a vertex has one or the other
#define PRT_LOCATION_CLUSTER 3
#define PRT_LOCATION_WEIGHTS 4 // and the following ones, four weights each

// Storage buffers.
#define PRT_BINDING_CONSTANTS 0

// Texture units.
#define PRT_UNIT_BASE_COLOR 0
#define PRT_UNIT_BACKGROUND 1

#endif
