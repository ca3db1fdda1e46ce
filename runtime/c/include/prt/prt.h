/* The runtime for programs in C, and for languages that call C.
 *
 * No function throws, none keeps state beyond the handles it gives out. Those that can fail return a status
 * and write a line for people to `message`, which may be null. Handles may be used from several threads at
 * once as long as nobody destroys them. Conventions, units and layouts are those of the C++ headers: SH with
 * Condon-Shortley phase, order N for N*N coefficients, right-handed axes with +Y up, linear Rec. 709.
 * Stable: it changes with the minor version only.
 */
#ifndef PRT_PRT_H
#define PRT_PRT_H

#include "prt/version.h"

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define PRT_API
#else
#define PRT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum prt_status {
    PRT_OK = 0,
    PRT_BAD_ARGUMENT = 1, /* a null pointer, an order outside 1..10, a direction of length 0, a mirrored
                             matrix, what is not finite */
    PRT_BAD_FILE = 2,     /* missing, damaged, or without what is wanted */
    PRT_NO_MEMORY = 3,
    PRT_TOO_SMALL = 4, /* the buffer; what it needs is written to *size */
    PRT_INTERNAL = 5   /* none of these: a mistake in the library, which the message may help to find */
} prt_status;

typedef struct prt_message {
    char text[256];
} prt_message;

/* A light: `order`, and order*order colors (r, g, b) of the caller's. Everything that is written is finite:
 * numbers that are not, or that floats do not hold the result of, are a PRT_BAD_ARGUMENT, after which what
 * the pointers lead to is as it was. Directions are unit. */

/* Writes the order*order basis values in unit direction `direction` to `basis`. */
PRT_API prt_status prt_sh_evaluate(int order, const float direction[3], float* basis, prt_message* message);
/* The product of two functions, truncated to `order` bands; `out` may be either. */
PRT_API prt_status prt_sh_multiply(int order, const float* a, const float* b, float* out,
                                   prt_message* message);
/* Rotates functions of one channel by `rotation`, columns first (OpenGL's order); `out` may be `in`. */
PRT_API prt_status prt_sh_rotate(int order, const float rotation[9], const float* in, float* out,
                                 prt_message* message);

PRT_API prt_status prt_light_constant(int order, const float radiance[3], float* light, prt_message* message);
PRT_API prt_status prt_light_directional(int order, const float towards[3], const float irradiance[3],
                                         float* light, prt_message* message);
PRT_API prt_status prt_light_cone(int order, const float axis[3], float half_angle, const float radiance[3],
                                  float* light, prt_message* message);
PRT_API prt_status prt_light_sphere(int order, const float center[3], float radius, const float radiance[3],
                                    float* light, prt_message* message);
PRT_API prt_status prt_light_disc(int order, const float center[3], const float normal[3], float radius,
                                  const float radiance[3], float* light, prt_message* message);
PRT_API prt_status prt_light_hemisphere(int order, const float up[3], const float top[3],
                                        const float bottom[3], float* light, prt_message* message);
/* What the center column of a lat-long image looks at: +Z as OpenEXR says, or +X as three.js, glTF viewers
 * and Blender show it. */
typedef enum prt_center { PRT_CENTER_Z = 0, PRT_CENTER_X = 1 } prt_center;
typedef struct prt_image {
    int width, height;
    const float* pixels; /* (r, g, b), rows from the top */
} prt_image;
/* The top row is +Y, `center` a prt_center. Bad pixels are an error. `threads` 0: all. */
PRT_API prt_status prt_light_from_lat_long(int order, const prt_image* image, int center, int threads,
                                           float* light, prt_message* message);
/* An environment map, .exr or .hdr; `center` counts where it is lat-long. */
PRT_API prt_status prt_light_from_file(int order, const char* path, int center, float* light,
                                       prt_message* message);
/* A sun: a disc of uniform radiance far away. */
typedef struct prt_sun {
    float towards[3];    /* unit, to its middle */
    float irradiance[3]; /* on a receiver that faces it */
    float half_angle;    /* radians; 0: no extent */
} prt_sun;
/* A light file of prt project (docs/format.md), whose suns prt project --suns finds in an image: the first
 * `order` bands of its sky, and its suns. *count: of `suns` in, those of the file out; `suns` may be null
 * where that is 0. */
PRT_API prt_status prt_light_from_light_file(int order, const char* path, float* sky, prt_sun* suns,
                                             size_t* count, prt_message* message);
/* Suns together as one light: `suns` of prt_model_form_constants_apart. */
PRT_API prt_status prt_light_suns(int order, const prt_sun* suns, size_t count, float* light,
                                  prt_message* message);
/* Rotates all three channels by `rotation`, columns first, in place. An object that turns wants its lighting
 * turned by the inverse. */
PRT_API prt_status prt_light_rotate(int order, const float rotation[9], float* light, prt_message* message);
/* The least filter of the bands under which the light is nowhere negative, in place: for lights in pictures.
 * A turned light is deringed before it is turned, once. */
PRT_API prt_status prt_light_dering(int order, float* light, prt_message* message);

/* A model that prt compress has written. */
typedef struct prt_model prt_model;

PRT_API prt_status prt_model_load(const char* path, prt_model** model, prt_message* message);
/* From a .glb in memory, which may be freed afterwards. */
PRT_API prt_status prt_model_load_memory(const void* bytes, size_t size, prt_model** model,
                                         prt_message* message);
PRT_API void prt_model_destroy(prt_model* model); /* null is fine */

/* 1 and 2 were formats that are no more. */
typedef enum prt_weight_format { PRT_FLOAT32 = 0, PRT_PACKED = 3 } prt_weight_format;

typedef struct prt_model_info {
    int order, channels;
    size_t receivers; /* vertices of all meshes */
    size_t clusters;
    size_t rows; /* of constants, 4 floats each: per cluster its mean, 3 for each guide, its directions */
    prt_weight_format format;
    size_t stride;                 /* bytes of weights of a receiver */
    const void* weights;           /* [receivers][stride], for the attributes prt_weights_* or prt_words_* */
    const uint16_t* cluster_of;    /* [receivers], for prt_cluster; packed weights hold it */
    const uint32_t* cluster_table; /* [clusters][4], for prt_clusters */
    size_t meshes;
    int direct_apart; /* 1 where suns can be lit apart from the sky, else 0 */
} prt_model_info;
/* Pointers live as long as the model. */
PRT_API prt_status prt_model_get_info(const prt_model* model, prt_model_info* out, prt_message* message);

/* What prt_exit_radiance(position, normal) of the vertex shader reads of a mesh. */
typedef struct prt_vertex_inputs {
    int normals, positions; /* 1 where it does, else 0 */
    float guide_origin[3];  /* metres: PRT_GUIDE_ORIGIN for positions as prt_mesh has them */
    double origin[3];       /* metres, in the file's world: where those are seen from */
} prt_vertex_inputs;
PRT_API prt_status prt_model_get_vertex_inputs(const prt_model* model, prt_vertex_inputs* out,
                                               prt_message* message);

/* How many lamps of the scene have strengths. */
PRT_API prt_status prt_model_count_lamps(const prt_model* model, size_t* lamps, prt_message* message);
/* The name of one, which lives as long as the model. */
PRT_API prt_status prt_model_lamp_name(const prt_model* model, size_t lamp, const char** name,
                                       prt_message* message);

typedef struct prt_mesh {
    size_t vertices;
    size_t first_receiver;  /* of the first vertex */
    const float* positions; /* [vertices][3], metres, axes of the world, seen from prt_vertex_inputs.origin */
    const float* normals;   /* [vertices][3], unit; zero where neither file nor triangles give one */
    const float* texcoords; /* [vertices][2], or null */
    size_t indices;
    const uint32_t* index; /* triangles, counter-clockwise */
    float base_color[4];   /* linear */
} prt_mesh;
PRT_API prt_status prt_model_get_mesh(const prt_model* model, size_t mesh, prt_mesh* out,
                                      prt_message* message);

/* Writes the constants of all clusters, [rows][4]. Allocates nothing. Coefficients of the light are at most
 * 1e20, constants at most 1e30; after PRT_BAD_ARGUMENT for these `constants` may be written. */
PRT_API prt_status prt_model_form_constants(const prt_model* model, int order, const float* light,
                                            float* constants, prt_message* message);
/* The same for a sky without its suns, whose direct light the renderer adds with sharp shadows, and for
 * their light, which the model is lit by after a bounce; `suns` may be null: there are none. Only a model
 * whose transfer keeps direct light apart knows the two apart: info.direct_apart. `lamps`: their strengths,
 * [lamps][3], at most 1e20; null: 1, as in the scene and as without this function. */
PRT_API prt_status prt_model_form_constants_apart(const prt_model* model, int order, const float* sky,
                                                  const float* suns, const float* lamps, float* constants,
                                                  prt_message* message);
/* What the vertex shader computes from constants of at most 1e30: exit radiance for albedo 1, [receivers][3].
 */
PRT_API prt_status prt_model_evaluate(const prt_model* model, const float* constants, float* radiance,
                                      prt_message* message);

typedef enum prt_language { PRT_GLSL450 = 0, PRT_GLSL330 = 1, PRT_ESSL300 = 2, PRT_VULKAN = 3 } prt_language;
typedef enum prt_constants {
    PRT_CONSTANTS_IN_BUFFER = 0,
    PRT_CONSTANTS_IN_BLOCK = 1,
    PRT_CONSTANTS_IN_TEXTURE = 2
} prt_constants;
/* The vertex shader of the model: a prt_language, a prt_constants. *size: of `source` in, with the final 0;
 * what it takes out. Its inputs: `position` at location 0, prt_mesh.positions as they are, whatever moves the
 * model (view_projection does that); `normal` at location 15, prt_mesh.normals, where
 * prt_vertex_inputs.normals; from 4 on the weights, prt_words_* where they are packed, else prt_weights_*,
 * and prt_cluster at 3. */
PRT_API prt_status prt_model_shader(const prt_model* model, int language, int constants, char* source,
                                    size_t* size, prt_message* message);

/* Instances that share the transfer of their mesh, in a file that prt bake --instances has written and prt
 * compress compressed. Its meshes are there once, with positions and normals in their own frames.
 * Experimental: what is called prt_instances_* may change with any version. */
typedef struct prt_instances_info {
    size_t count;     /* 0: the model has none, and all else is 0 */
    size_t constants; /* vectors of 4 floats that a lighting takes */
    const float*
        worlds; /* [count][3][4], rows of the matrix of positions as prt_mesh has them into the world */
    const float* tables; /* [count][2][4], instance_0 and instance_1 of the vertex shader */
    double most_degrees; /* by which the lighting of an instance is turned off */
} prt_instances_info;
/* Pointers live as long as the model. */
PRT_API prt_status prt_instances_get_info(const prt_model* model, prt_instances_info* out,
                                          prt_message* message);
/* Which instances draw a prt_mesh; *count 0: it is drawn once, as the meshes of other models are. */
PRT_API prt_status prt_instances_of_mesh(const prt_model* model, size_t mesh, size_t* first, size_t* count,
                                         prt_message* message);
/* Writes the constants of all instances, [constants][4], which take the place of the model's own where these
 * are drawn. Lighting as prt_model_form_constants_apart takes it, without lamps. `threads` 0: all. */
PRT_API prt_status prt_instances_form_constants(const prt_model* model, int order, const float* sky,
                                                const float* suns, int threads, float* constants,
                                                prt_message* message);
/* The vertex shader of instances. Beside what that of the model takes: worlds at locations 10 to 12, tables
 * at 13 and 14. Constants are in a buffer or a texture. *size as for prt_model_shader. */
PRT_API prt_status prt_instances_shader(const prt_model* model, int language, int constants, char* source,
                                        size_t* size, prt_message* message);

/* The volume of probes of a file that prt compress has written, for what moves through the scene.
 * Experimental: what is called prt_volume_* may change with any version. */
typedef struct prt_volume prt_volume;

PRT_API prt_status prt_volume_load(const char* path, prt_volume** volume, prt_message* message);
PRT_API prt_status prt_volume_load_memory(const void* bytes, size_t size, prt_volume** volume,
                                          prt_message* message);
PRT_API void prt_volume_destroy(prt_volume* volume); /* null is fine */

typedef struct prt_volume_info {
    int order;          /* of lighting */
    int incident_order; /* n = 2..4: n*n coefficients of the light that comes in at a probe */
    size_t probes;
    size_t rows;      /* of constants, 4 floats each */
    size_t lamps;     /* that have strengths */
    int direct_apart; /* 1 where suns can be lit apart from the sky, else 0 */
    float corner[3];  /* metres: the least one, seen from `origin` as all positions are */
    float spacing;    /* metres, of the finest probes */
    double origin[3]; /* metres, in the file's world; as prt_vertex_inputs has it */
} prt_volume_info;
PRT_API prt_status prt_volume_get_info(const prt_volume* volume, prt_volume_info* out, prt_message* message);

/* The 3D textures of prt_volume.glsl: width, height, depth. Light is RGBA16F, filtered linearly; the others
 * do not change with the lighting and are not filtered. Pointers live as long as the volume. */
typedef struct prt_volume_textures {
    int light[3], sights[3], index[3];
    size_t light_bytes;
    const uint32_t* sight_texels; /* RG32UI */
    const uint32_t* index_texels; /* R32UI */
} prt_volume_textures;
PRT_API prt_status prt_volume_get_textures(const prt_volume* volume, prt_volume_textures* out,
                                           prt_message* message);

/* What a volume is lit with: coefficients as prt_model_form_constants_apart takes them. */
typedef struct prt_lighting {
    int order;
    const float* sky;
    const float* suns;  /* may be null: none is apart */
    const float* lamps; /* may be null */
    const float* sun;   /* direction to the sun whose visibility is wanted; may be null */
} prt_lighting;
/* Writes constants, [rows][4]. Allocates nothing. Limits as for a model. */
PRT_API prt_status prt_volume_form_constants(const prt_volume* volume, const prt_lighting* lighting,
                                             float* constants, prt_message* message);
/* Writes what probes `first` to `last` - 1 have in the texture of light, to `texels` [light_bytes]; from
 * several threads at once for different probes. Allocates nothing. */
PRT_API prt_status prt_volume_form_light(const prt_volume* volume, const float* constants, size_t first,
                                         size_t last, void* texels, prt_message* message);
/* Writes the light that comes in at probes, [probes][n*n][3], for use without textures. */
PRT_API prt_status prt_volume_evaluate(const prt_volume* volume, const float* constants, float* incident,
                                       prt_message* message);

/* A place that is lit: `normal`, unit, of its surface, or zero. */
typedef struct prt_volume_place {
    float position[3], normal[3];
} prt_volume_place;
/* Mixes the light of probes around a place, [n*n][3]; those behind surfaces are left out. Allocates nothing.
 */
PRT_API prt_status prt_volume_incident(const prt_volume* volume, const float* incident,
                                       const prt_volume_place* place, float* light, prt_message* message);
/* Irradiance over pi of what faces the normal of `place`: times the albedo it is exit radiance. */
PRT_API prt_status prt_volume_irradiance(const prt_volume* volume, const float* incident,
                                         const prt_volume_place* place, float irradiance[3],
                                         prt_message* message);

/* The functions that look a volume up, to be put behind the version line of a shader of any language;
 * positions are seen from `origin`. *size as for prt_model_shader. */
PRT_API prt_status prt_volume_functions(const prt_volume* volume, char* source, size_t* size,
                                        prt_message* message);
/* The compute shader that forms the texture of light: PRT_GLSL450 or PRT_VULKAN. */
PRT_API prt_status prt_volume_shader(const prt_volume* volume, int language, char* source, size_t* size,
                                     prt_message* message);

#ifdef __cplusplus
}
#endif

#endif
