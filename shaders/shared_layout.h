// Numbers that the runtime and every game share between GLSL and C++. Uses only the preprocessor.
#ifndef PRT_SHARED_LAYOUT_H
#define PRT_SHARED_LAYOUT_H

// Vertex attribute locations.
#define PRT_LOCATION_POSITION 0
#define PRT_LOCATION_TEXCOORD 1
#define PRT_LOCATION_COLOR 2
#define PRT_LOCATION_RADIANCE 3 // same location as the cluster: a vertex has one of the two
#define PRT_LOCATION_CLUSTER 3
#define PRT_LOCATION_WEIGHTS 4 // and following locations, four weights each; GLSL 3.3 needs literals
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
#define PRT_LOCATION_INSTANCE_X 10 // matrix of an instance, whose mesh has at most 24 weights
#define PRT_LOCATION_INSTANCE_Y 11
#define PRT_LOCATION_INSTANCE_Z 12
#define PRT_LOCATION_INSTANCE_0 13 // its rows of prt::InstanceRelighter::table
#define PRT_LOCATION_INSTANCE_1 14
#define PRT_LOCATION_AO 4       // if there are no weights
#define PRT_LOCATION_LIGHTMAP 4 // if there are no weights
#define PRT_LOCATION_NORMAL 15  // same location as the last weights, which models with predictors do not have

// Storage buffers.
#define PRT_BINDING_CONSTANTS 0
#define PRT_BINDING_CLUSTERS 1
#define PRT_BINDING_MATRIX 2
#define PRT_BINDING_LIGHT 3
#define PRT_BINDING_VOLUME_WORDS 4
#define PRT_BINDING_VOLUME_PROBES 5
#define PRT_BINDING_OCCLUDERS 6 // a uniform block
#define PRT_BINDING_LOBES 7     // a uniform block
#define PRT_BINDING_EMISSION_TEXCOORDS 10
#define PRT_BINDING_PALETTE 11 // moving vertices: skinning.glsl
#define PRT_BINDING_INFLUENCES 12

// Surfaces: prt::AlphaMode.
#define PRT_ALPHA_OPAQUE 0
#define PRT_ALPHA_MASK 1
#define PRT_ALPHA_BLEND 2

// Entry of a cluster in its table, a uvec4 (prt::ClusterLayout): the first row of its constants, its number
// of components, and the widths of their weights in two words.
#define PRT_CLUSTER_FIRST_ROW 0
#define PRT_CLUSTER_COMPONENTS 1
#define PRT_CLUSTER_WIDTHS 2

// Texture units.
#define PRT_UNIT_WORD_IMAGES 2 // and following units, one per word of a texel
#define PRT_UNIT_BASE_COLOR 0
#define PRT_UNIT_BACKGROUND 1
#define PRT_UNIT_EMISSION 7
#define PRT_UNIT_LIGHTMAP 14
#define PRT_UNIT_VOLUME_LIGHT 15
#define PRT_UNIT_VOLUME_VISIBILITY 16
#define PRT_UNIT_VOLUME_INDEX 17
#define PRT_UNIT_OCCLUDERS 18

// Images.
#define PRT_IMAGE_TEXELS 3 // differs from the bindings of its shader, because Vulkan has one range for all

// Weights of the probes of a volume, defined in runtime/domains/volume_weights.h.
#define PRT_VOLUME_NORMAL_BIAS 0.25
#define PRT_VOLUME_VISIBILITY_CELLS 4.0
#define PRT_VOLUME_VISIBILITY_FULL 0.8
#define PRT_VOLUME_VISIBILITY_NONE 1.03
#define PRT_VOLUME_HIDDEN_WEIGHT 0.0001

// Occlusion volumes of moving objects, defined in prt/core/occlusion_volume.h.
#define PRT_OCCLUDER_SIDE 8
#define PRT_OCCLUDER_FADE 0.6
#define PRT_OCCLUDER_BORDER 0.4
// Maximum number of lobe profiles: prt/core/lobes.h.
#define PRT_MAX_PROFILES 256

#ifndef PRT_MAX_OCCLUDERS
#define PRT_MAX_OCCLUDERS 32
#endif

#endif
