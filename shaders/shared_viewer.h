// Numbers that the viewer shares between GLSL and C++, in addition to those of shared_layout.h.
#ifndef PRT_SHARED_VIEWER_H
#define PRT_SHARED_VIEWER_H

// Storage buffers: exit radiance of uncompressed transfer; sums of the difference of two pictures; and, with
// the same binding, for each texel of a map the receiver whose radiance it takes.
#define PRT_BINDING_RAW_RADIANCE 4
#define PRT_BINDING_DIFFERENCE 5
#define PRT_BINDING_TEXEL_RECEIVERS 5
#define PRT_BINDING_PROBE_POSITIONS 5
#define PRT_BINDING_LOBE_WORDS 13
#define PRT_BINDING_INSTANCE_RADIANCE 14

// Texture units.
#define PRT_UNIT_GBUFFER_BASE 2
#define PRT_UNIT_GBUFFER_NORMAL 3
#define PRT_UNIT_GBUFFER_RADIANCE 4
#define PRT_UNIT_GBUFFER_DEPTH 5
#define PRT_UNIT_SSAO 6
#define PRT_UNIT_LEFT 2
#define PRT_UNIT_RIGHT 3
#define PRT_AO_LEVELS 31 // maximum of five bits

// Number of cells of the spheres that show probes.
#define PRT_PROBE_COLUMNS 10
#define PRT_PROBE_ROWS 6

#endif
