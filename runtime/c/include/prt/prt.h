/* The runtime for programs in C, and for languages that call C.
 *
 * No function throws, and no function keeps state outside the handles it returns. Functions that can fail
 * return a status and write one line of text to `message`, which may be null. Several threads may use a
 * handle at once, until it is destroyed. Conventions, units and layouts are those of the C++ headers: SH with
 * Condon-Shortley phase, order N for N*N coefficients, right-handed axes with +Y up, linear Rec. 709. Stable:
 * the interface changes with the minor version only. */
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
                             matrix, a value that is not finite */
    PRT_BAD_FILE = 2,     /* the file is missing, damaged, or lacks the requested data */
    PRT_NO_MEMORY = 3,
    PRT_TOO_SMALL = 4, /* the buffer is too small; the required size is written to *size */
    PRT_INTERNAL = 5   /* any other failure: a bug in the library; the message may help to find it */
} prt_status;

typedef struct prt_message {
    char text[256];
} prt_message;

/* Lights are passed as `order` and an array of order*order colors (r, g, b), which the caller owns. All
 * outputs are finite. For inputs that are not finite, and results that overflow a float, functions return
 * PRT_BAD_ARGUMENT and do not change output arrays. Directions are unit vectors. */

/* Writes the order*order basis values in unit direction `direction` to `basis`. */
PRT_API prt_status prt_sh_evaluate(int order, const float direction[3], float* basis, prt_message* message);
/* Computes the product of two functions of one channel, truncated to `order` bands; `out` may be `a` or `b`.
 */
PRT_API prt_status prt_sh_multiply(int order, const float* a, const float* b, float* out,
                                   prt_message* message);
/* Rotates functions of one channel by `rotation`, in column-major order (as in OpenGL); `out` may be `in`. */
PRT_API prt_status prt_sh_rotate(int order, const float rotation[9], const float* in, float* out,
                                 prt_message* message);

/* Writes light of radiance `radiance` from every direction to `light`. */
PRT_API prt_status prt_light_constant(int order, const float radiance[3], float* light, prt_message* message);
/* Writes a distant light without extent to `light`. `towards` points to the light; `irradiance` is that of a
 * receiver that faces it. */
PRT_API prt_status prt_light_directional(int order, const float towards[3], const float irradiance[3],
                                         float* light, prt_message* message);
/* Writes light of radiance `radiance` inside the cone of half angle `half_angle` (radians, at most pi) about
 * `axis` to `light`. */
PRT_API prt_status prt_light_cone(int order, const float axis[3], float half_angle, const float radiance[3],
                                  float* light, prt_message* message);
/* Writes the light of a sphere of radiance `radiance`, seen from the origin, to `light`. The origin must be
 * outside the sphere. */
PRT_API prt_status prt_light_sphere(int order, const float center[3], float radius, const float radiance[3],
                                    float* light, prt_message* message);
/* Writes the light of a disc of radiance `radiance`, seen from the origin, to `light`. The disc emits to the
 * side of its normal. */
PRT_API prt_status prt_light_disc(int order, const float center[3], const float normal[3], float radius,
                                  const float radiance[3], float* light, prt_message* message);
/* Writes light whose radiance changes from `bottom` to `top` linearly in the cosine to `up` to `light`. */
PRT_API prt_status prt_light_hemisphere(int order, const float up[3], const float top[3],
                                        const float bottom[3], float* light, prt_message* message);
/* Direction of the center column of a lat-long image: +Z as in OpenEXR, or +X as in three.js, glTF viewers
 * and Blender. */
typedef enum prt_center { PRT_CENTER_Z = 0, PRT_CENTER_X = 1 } prt_center;
/* A lat-long image. */
typedef struct prt_image {
    int width, height;
    const float* pixels; /* (r, g, b), rows from the top */
} prt_image;
/* Projects a lat-long image, whose top row is +Y, into `light`. `center` is a prt_center. Pixels that are
 * negative or not finite are an error. `threads` 0: all. */
PRT_API prt_status prt_light_from_lat_long(int order, const prt_image* image, int center, int threads,
                                           float* light, prt_message* message);
/* Loads an environment map, .exr or .hdr, and projects it into `light`. `center` is used for lat-long images
 * only. */
PRT_API prt_status prt_light_from_file(int order, const char* path, int center, float* light,
                                       prt_message* message);
/* A sun: a distant disc of uniform radiance. */
typedef struct prt_sun {
    float towards[3];    /* unit direction to its center */
    float irradiance[3]; /* irradiance of a receiver that faces it */
    float half_angle;    /* radians; 0: no extent */
} prt_sun;
/* Loads a light file of `prt project` (docs/format.md): the first `order` bands of its sky, and its suns.
 * *count: capacity of `suns` on entry, number of suns in the file on return. `suns` may be null if the
 * capacity is 0. */
PRT_API prt_status prt_light_from_light_file(int order, const char* path, float* sky, prt_sun* suns,
                                             size_t* count, prt_message* message);
/* Writes the sum of all suns to `light`: the argument `suns` of prt_model_update_constants_separate. */
PRT_API prt_status prt_light_suns(int order, const prt_sun* suns, size_t count, float* light,
                                  prt_message* message);
/* Rotates all three channels by `rotation`, in column-major order, in place. For a rotated object, rotate its
 * lighting by the inverse. */
PRT_API prt_status prt_light_rotate(int order, const float rotation[9], float* light, prt_message* message);
/* Removes ringing from a light, in place: applies the weakest filter of the bands that makes the light
 * non-negative in every direction. Intended for lights from images. Dering a light once, before rotating it.
 */
PRT_API prt_status prt_light_dering(int order, float* light, prt_message* message);

/* A model that `prt compress` has written. */
typedef struct prt_model prt_model;

/* Loads a .glb file. Destroy the model with prt_model_destroy. */
PRT_API prt_status prt_model_load(const char* path, prt_model** model, prt_message* message);
/* Loads a .glb file from memory, which may be freed afterwards. Destroy the model with prt_model_destroy. */
PRT_API prt_status prt_model_load_memory(const void* bytes, size_t size, prt_model** model,
                                         prt_message* message);
/* Destroys a model; `model` may be null. */
PRT_API void prt_model_destroy(prt_model* model);

/* Storage of weights. Values 1 and 2 belonged to formats that have been removed. */
typedef enum prt_weight_format { PRT_FLOAT32 = 0, PRT_PACKED = 3 } prt_weight_format;

/* Properties of a model. */
typedef struct prt_model_info {
    int order, channels;
    size_t receivers; /* vertices of all meshes */
    size_t clusters;
    size_t rows; /* number of constants, 4 floats each: per cluster the mean, 3 rows per predictor, the basis
                    directions */
    prt_weight_format format;
    size_t stride;                 /* size of the weights of a receiver in bytes */
    const void* weights;           /* [receivers][stride], for the attributes prt_weights_* or prt_words_* */
    const uint16_t* cluster_of;    /* [receivers], for prt_cluster; packed weights include it */
    const uint32_t* cluster_table; /* [clusters][4], for prt_clusters */
    size_t meshes;
    int has_direct_term; /* 1 if suns can be lit separately from the sky, else 0 */
} prt_model_info;
/* Returns the properties of a model. Pointers are valid as long as the model exists. */
PRT_API prt_status prt_model_get_info(const prt_model* model, prt_model_info* out, prt_message* message);

/* Mesh attributes that the function prt_exit_radiance(position, normal) of the vertex shader reads. */
typedef struct prt_vertex_inputs {
    int normals, positions;    /* 1 if read, else 0 */
    float predictor_origin[3]; /* metres: PRT_PREDICTOR_ORIGIN for positions as in prt_mesh */
    double origin[3];          /* metres, in the file's world: origin of the positions in prt_mesh */
} prt_vertex_inputs;
/* Returns the mesh attributes that the vertex shader of a model reads. */
PRT_API prt_status prt_model_get_vertex_inputs(const prt_model* model, prt_vertex_inputs* out,
                                               prt_message* message);

/* Returns the number of lamps of the scene; each has its own strength. */
PRT_API prt_status prt_model_count_lamps(const prt_model* model, size_t* lamps, prt_message* message);
/* Returns the name of a lamp, which is valid as long as the model exists. */
PRT_API prt_status prt_model_lamp_name(const prt_model* model, size_t lamp, const char** name,
                                       prt_message* message);

/* A mesh of a model. */
typedef struct prt_mesh {
    size_t vertices;
    size_t first_receiver; /* receiver of the first vertex */
    const float*
        positions;        /* [vertices][3], metres, axes of the world, relative to prt_vertex_inputs.origin */
    const float* normals; /* [vertices][3], unit; zero if neither the file nor the triangles define one */
    const float* texcoords; /* [vertices][2], or null */
    size_t indices;
    const uint32_t* index; /* triangles, counter-clockwise */
    float base_color[4];   /* linear */
} prt_mesh;
/* Returns mesh `mesh` of a model. Pointers are valid as long as the model exists. */
PRT_API prt_status prt_model_get_mesh(const prt_model* model, size_t mesh, prt_mesh* out,
                                      prt_message* message);

/* Computes the constants of all clusters for a light, [rows][4]. Allocates nothing. Coefficients of the light
 * are at most 1e20, constants at most 1e30; if one is larger, the function returns PRT_BAD_ARGUMENT, and
 * `constants` may have been changed. */
PRT_API prt_status prt_model_update_constants(const prt_model* model, int order, const float* light,
                                              float* constants, prt_message* message);
/* Computes the constants for a sky and separate suns, [rows][4]. The renderer adds the direct light of the
 * suns with sharp shadows; the constants contain their light only after a bounce. `suns` may be null: no
 * suns. Only a model whose transfer stores direct light separately supports suns: info.has_direct_term.
 * `lamps`: strengths of the lamps, [lamps][3], at most 1e20; null: 1, as in the scene and as in
 * prt_model_update_constants. */
PRT_API prt_status prt_model_update_constants_separate(const prt_model* model, int order, const float* sky,
                                                       const float* suns, const float* lamps,
                                                       float* constants, prt_message* message);
/* Computes exit radiance for albedo 1, [receivers][3], as the vertex shader does. Magnitudes of constants are
 * at most 1e30. */
PRT_API prt_status prt_model_evaluate(const prt_model* model, const float* constants, float* radiance,
                                      prt_message* message);

/* Shading languages: OpenGL 4.5, OpenGL 3.3, OpenGL ES 3.0 and WebGL 2, Vulkan. */
typedef enum prt_language { PRT_GLSL450 = 0, PRT_GLSL330 = 1, PRT_ESSL300 = 2, PRT_VULKAN = 3 } prt_language;
/* Storage of the constants for a vertex shader. */
typedef enum prt_constants {
    PRT_CONSTANTS_IN_BUFFER = 0,
    PRT_CONSTANTS_IN_BLOCK = 1,
    PRT_CONSTANTS_IN_TEXTURE = 2
} prt_constants;
/* Writes the source of the model's vertex shader to `source`. `language` is a prt_language, `constants` a
 * prt_constants. *size: on entry the size of `source` in bytes including the final 0, on return the required
 * size. Inputs of the shader: `position` at location
 * 0, prt_mesh.positions unchanged (view_projection holds the transform of the model); `normal` at location
 * 15, prt_mesh.normals, if prt_vertex_inputs.normals is set; weights from location 4: prt_words_* if packed,
 * else prt_weights_* with prt_cluster at location 3. */
PRT_API prt_status prt_model_shader(const prt_model* model, int language, int constants, char* source,
                                    size_t* size, prt_message* message);

/* Instances that share the transfer of their mesh, in a file written by prt bake --instances and prt
 * compress. The file stores each mesh once, with positions and normals in its own frame. Experimental:
 * prt_instances_* may change with any version. */
typedef struct prt_instances_info {
    size_t count;        /* 0: the model has no instances, and all other members are 0 */
    size_t constants;    /* number of constants for a lighting, 4 floats each */
    const float* worlds; /* [count][3][4], rows of the matrix from positions as in prt_mesh to the world */
    const float* tables; /* [count][2][4], instance_0 and instance_1 of the vertex shader */
    double max_degrees;  /* maximum angular error of an instance's rounded rotation, in degrees */
} prt_instances_info;
/* Returns the instances of a model. Pointers are valid as long as the model exists. */
PRT_API prt_status prt_instances_get_info(const prt_model* model, prt_instances_info* out,
                                          prt_message* message);
/* Returns the range of instances that draw mesh `mesh`. *count is 0 if the mesh is drawn once, like the
 * meshes of models without instances. */
PRT_API prt_status prt_instances_of_mesh(const prt_model* model, size_t mesh, size_t* first, size_t* count,
                                         prt_message* message);
/* Computes the constants of all instances, [constants][4], which replace the constants of the model when
 * instances are drawn. `sky` and `suns` are those of prt_model_update_constants_separate. `threads` 0: all.
 */
PRT_API prt_status prt_instances_update_constants(const prt_model* model, int order, const float* sky,
                                                  const float* suns, int threads, float* constants,
                                                  prt_message* message);
/* Writes the source of the vertex shader for instances. It has the inputs of prt_model_shader, and the rows
 * of prt_instances_info.worlds at locations 10 to 12 and of prt_instances_info.tables at 13 and 14. Constants
 * are in a buffer or a texture. *size is used as in prt_model_shader. */
PRT_API prt_status prt_instances_shader(const prt_model* model, int language, int constants, char* source,
                                        size_t* size, prt_message* message);

/* A volume of probes in a file of `prt compress`. It lights objects that move through the scene.
 * Experimental: prt_volume_* may change with any version. */
typedef struct prt_volume prt_volume;

/* Loads the volume of a .glb file. Destroy it with prt_volume_destroy. */
PRT_API prt_status prt_volume_load(const char* path, prt_volume** volume, prt_message* message);
/* Loads the volume of a .glb file in memory, which may be freed afterwards. Destroy it with
 * prt_volume_destroy. */
PRT_API prt_status prt_volume_load_memory(const void* bytes, size_t size, prt_volume** volume,
                                          prt_message* message);
/* Destroys a volume; `volume` may be null. */
PRT_API void prt_volume_destroy(prt_volume* volume);

/* Properties of a volume. */
typedef struct prt_volume_info {
    int order;          /* order of the lighting */
    int incident_order; /* n = 2..4: a probe has n*n coefficients of incident light */
    size_t probes;
    size_t rows;         /* number of constants, 4 floats each */
    size_t lamps;        /* number of lamps with strengths */
    int has_direct_term; /* 1 if suns can be lit separately from the sky, else 0 */
    float corner[3];     /* metres: minimum corner, relative to `origin` like all positions */
    float spacing;       /* metres, distance of the finest probes */
    double origin[3];    /* metres, in the file's world; see prt_vertex_inputs.origin */
} prt_volume_info;
/* Returns the properties of a volume. */
PRT_API prt_status prt_volume_get_info(const prt_volume* volume, prt_volume_info* out, prt_message* message);

/* The 3D textures of prt_volume.glsl: their width, height and depth, and the texels of two of them. The light
 * texture is RGBA16F with linear filtering. The other two do not depend on the lighting and are not filtered.
 * Pointers are valid as long as the volume exists. */
typedef struct prt_volume_textures {
    int light[3], visibility[3], index[3];
    size_t light_bytes;
    const uint32_t* visibility_texels; /* RG32UI */
    const uint32_t* index_texels;      /* R32UI */
} prt_volume_textures;
/* Returns the textures of a volume. */
PRT_API prt_status prt_volume_get_textures(const prt_volume* volume, prt_volume_textures* out,
                                           prt_message* message);

/* Lighting of a volume: coefficients as in prt_model_update_constants_separate. */
typedef struct prt_lighting {
    int order;
    const float* sky;
    const float* suns;  /* may be null: no separate suns */
    const float* lamps; /* may be null */
    const float* sun;   /* direction to the sun whose visibility is computed; may be null */
} prt_lighting;
/* Computes the constants of a volume for a lighting, [rows][4]. Allocates nothing. Limits are those of
 * prt_model_update_constants. */
PRT_API prt_status prt_volume_update_constants(const prt_volume* volume, const prt_lighting* lighting,
                                               float* constants, prt_message* message);
/* Computes the texels of probes `first` to `last` - 1 of the light texture and writes them to `texels`
 * [light_bytes]. Several threads may process different probes at once. Allocates nothing. */
PRT_API prt_status prt_volume_update_light(const prt_volume* volume, const float* constants, size_t first,
                                           size_t last, void* texels, prt_message* message);
/* Computes the incident light at all probes, [probes][n*n][3], for use without textures. */
PRT_API prt_status prt_volume_evaluate(const prt_volume* volume, const float* constants, float* incident,
                                       prt_message* message);

/* A position to light, in metres. `normal` is the unit normal of its surface, or zero. */
typedef struct prt_volume_position {
    float position[3], normal[3];
} prt_volume_position;
/* Interpolates `incident`, the result of prt_volume_evaluate, at a position: `light` [n*n][3]. Probes behind
 * surfaces are excluded. Allocates nothing. */
PRT_API prt_status prt_volume_incident(const prt_volume* volume, const float* incident,
                                       const prt_volume_position* position, float* light,
                                       prt_message* message);
/* Computes irradiance divided by pi of a surface at `position` with its normal. Times the albedo, this is
 * exit radiance. `incident` is the result of prt_volume_evaluate. */
PRT_API prt_status prt_volume_irradiance(const prt_volume* volume, const float* incident,
                                         const prt_volume_position* position, float irradiance[3],
                                         prt_message* message);

/* Writes the source of the GLSL functions that look up a volume. Insert them after the version line of a
 * shader in any language. Positions are relative to prt_volume_info.origin. *size is used as in
 * prt_model_shader. */
PRT_API prt_status prt_volume_functions(const prt_volume* volume, char* source, size_t* size,
                                        prt_message* message);
/* Writes the source of the compute shader that computes the light texture. `language` is PRT_GLSL450 or
 * PRT_VULKAN. *size is used as in prt_model_shader. */
PRT_API prt_status prt_volume_shader(const prt_volume* volume, int language, char* source, size_t* size,
                                     prt_message* message);

#ifdef __cplusplus
}
#endif

#endif
