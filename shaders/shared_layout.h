// Numbers that GLSL and C++ share. Included by both: plain preprocessor only.
#ifndef PRT_SHARED_LAYOUT_H
#define PRT_SHARED_LAYOUT_H

// Vertex attribute locations.
#define PRT_LOCATION_POSITION 0
#define PRT_LOCATION_TEXCOORD 1
#define PRT_LOCATION_COLOR 2
#define PRT_LOCATION_RADIANCE 3 // shares its place with the cluster: a vertex has one or the other
#define PRT_LOCATION_CLUSTER 3
#define PRT_LOCATION_WEIGHTS 4 // and the following ones, four weights each; GLSL 3.3 wants plain numbers
#define PRT_LOCATION_WEIGHTS_1 5
#define PRT_LOCATION_WEIGHTS_2 6
#define PRT_LOCATION_WEIGHTS_3 7
#define PRT_LOCATION_WEIGHTS_4 8
#define PRT_LOCATION_WEIGHTS_5 9
#define PRT_LOCATION_WEIGHTS_6 10
#define PRT_LOCATION_WEIGHTS_7 11
#define PRT_LOCATION_WEIGHTS_8 12
#define PRT_LOCATION_WEIGHTS_9 13
#define PRT_LOCATION_WEIGHTS_10 14
#define PRT_LOCATION_WEIGHTS_11 15
#define PRT_LOCATION_AO 4      // where there are no weights
#define PRT_LOCATION_NORMAL 15 // shares its place with the last weights, which few models have

// Storage buffers.
#define PRT_BINDING_CONSTANTS 0
#define PRT_BINDING_CLUSTERS 1
#define PRT_BINDING_MATRIX 2
#define PRT_BINDING_LIGHT 3

// The baker's; its programs are others.
#define PRT_BINDING_NODES 1
#define PRT_BINDING_CORNERS 2
#define PRT_BINDING_SAMPLES 3
#define PRT_BINDING_DIRECTIONS 3 // depth maps have no samples, and no hits below
#define PRT_BINDING_RECEIVERS 4
#define PRT_BINDING_SUMS 5
#define PRT_BINDING_HITS 6
#define PRT_BINDING_HIT_COUNT 7
#define PRT_BINDING_BLOCKED 8
#define PRT_BINDING_TOUCHING 6
#define PRT_BINDING_TOUCHING_RANGES 7
#define PRT_BINDING_PASSES 8
#define PRT_BINDING_ALPHA_TRIANGLES 9
#define PRT_BINDING_ALPHA_MATERIALS 10
#define PRT_BINDING_ALPHA_TEXELS 11
// Uniform blocks.
#define PRT_BINDING_SH_FACTORS 0

// Surfaces: prt::AlphaMode and, beside it, glass; prt::Wrap.
#define PRT_ALPHA_OPAQUE 0
#define PRT_ALPHA_MASK 1
#define PRT_ALPHA_BLEND 2
#define PRT_ALPHA_GLASS 3
#define PRT_WRAP_REPEAT 0
#define PRT_WRAP_MIRROR 1
#define PRT_WRAP_CLAMP 2

// Spherical harmonics, and where the factors of band l and degree m of the recurrence stand.
#define PRT_MOST_ORDER 10
#define PRT_MOST_COEFFICIENTS (PRT_MOST_ORDER * PRT_MOST_ORDER)
#define PRT_SH_FACTOR(l, m) (PRT_MOST_ORDER * (l) + (m))

// A ray with less than this left is taken to end at the surface it meets.
#define PRT_LEAST_TRANSMITTANCE (1.0 / 1024.0)

// Rays that are generated and traced together, and the threads that do it.
#define PRT_CHUNK 1024
#define PRT_TRACE_THREADS 64

// A cluster's entry in its table, a uvec4 (prt::ClusterLayout): the first row of its constants, its components, the
// widths of their weights in two words.
#define PRT_CLUSTER_FIRST_ROW 0
#define PRT_CLUSTER_COMPONENTS 1
#define PRT_CLUSTER_WIDTHS 2

// Texture units.
#define PRT_UNIT_BASE_COLOR 0
#define PRT_UNIT_BACKGROUND 1
// The viewer's; its programs are others than the baker's.
#define PRT_UNIT_GBUFFER_BASE 2
#define PRT_UNIT_GBUFFER_NORMAL 3
#define PRT_UNIT_GBUFFER_RADIANCE 4
#define PRT_UNIT_GBUFFER_DEPTH 5
#define PRT_UNIT_SSAO 6
#define PRT_UNIT_LEFT 2
#define PRT_UNIT_RIGHT 3
#define PRT_AO_LEVELS 31 // largest value of five bits
// The baker's.
#define PRT_UNIT_OPAQUE_DEPTH 2
#define PRT_UNIT_LAST_DEPTH 3
#define PRT_UNIT_LAYER_COVERAGE 4

#endif
