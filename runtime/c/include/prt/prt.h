/* The runtime for programs in C, and for languages that call C.
 *
 * No function throws an exception or keeps state outside the handles (prt_model, prt_volume) that it returns.
 * Functions that can fail return a prt_status. On failure they write one line of text to `message`, on
 * success an empty text; `message` may be null. Several threads may use a handle at once, until one of them
 * destroys it. Pointers are required (null: PRT_BAD_ARGUMENT) unless a comment allows null. The library keeps
 * no pointer to an argument after a call. Conventions: SH with Condon-Shortley phase, order N = N*N
 * coefficients (1..10), right-handed axes with +Y up, lengths in metres, colors linear Rec. 709. Stable: the
 * interface changes with the minor version only. */
#ifndef PRT_PRT_H
#define PRT_PRT_H

#include "prt/core/version.h"

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

/* Result of a function. */
typedef enum prt_status {
    PRT_OK = 0,
    PRT_BAD_ARGUMENT = 1, /* an invalid argument, such as a null pointer, an order outside 1..10, a direction
                             of length 0, a matrix that is not a rotation, an index or enumerator out of
                             range, a value that is not finite */
    PRT_BAD_FILE = 2,     /* the file is missing, damaged, or lacks the requested data */
    PRT_NO_MEMORY = 3,    /* an allocation failed */
    PRT_TOO_SMALL = 4, /* the buffer is too small; the function writes the required size to *size or *count */
    PRT_INTERNAL = 5   /* any other failure: a bug in the library; the message may help to find it */
} prt_status;

/* One line of text that describes a failure, with a final 0; longer texts are cut. */
typedef struct prt_message {
    char text[256];
} prt_message;

/* A light is an array of order*order colors (r, g, b), 3*order*order floats in memory of the caller: SH
 * coefficients of the radiance from each direction. All outputs are finite. For inputs that are not finite,
 * and for results that overflow a float, functions return PRT_BAD_ARGUMENT and do not change output arrays,
 * unless a comment states otherwise. */

/* Writes the values of the order*order SH basis functions in direction `direction` to `basis` [order*order].
 * `direction` must have length 1; other lengths except 0 give values without meaning. */
PRT_API prt_status prt_sh_evaluate(int order, const float direction[3], float* basis, prt_message* message);
/* Computes the SH coefficients of the product of two functions of direction, truncated to `order` bands. `a`,
 * `b` and `out` are [order*order], one channel each; `out` may be `a` or `b`. */
PRT_API prt_status prt_sh_multiply(int order, const float* a, const float* b, float* out,
                                   prt_message* message);
/* Rotates the function with SH coefficients `in` [order*order], one channel, and writes the coefficients to
 * `out` [order*order], which may be `in`. `rotation` is a 3x3 rotation matrix R in column-major order (as
 * in OpenGL): the new value in direction R w is the old value in direction w. */
PRT_API prt_status prt_sh_rotate(int order, const float rotation[9], const float* in, float* out,
                                 prt_message* message);

/* Writes to `light` [order*order][3] the light with radiance `radiance` from every direction. */
PRT_API prt_status prt_light_constant(int order, const float radiance[3], float* light, prt_message* message);
/* Writes to `light` [order*order][3] a distant light without extent. `towards` is the direction from the
 * receiver to the light, of any length except 0. `irradiance` (radiance times sr) arrives at an unoccluded
 * receiver whose normal is `towards`; `order` bands approximate this. */
PRT_API prt_status prt_light_directional(int order, const float towards[3], const float irradiance[3],
                                         float* light, prt_message* message);
/* Writes to `light` [order*order][3] the light with radiance `radiance` from all directions within
 * `half_angle` (radians, 0..pi) of `axis`, and radiance 0 from all others. `axis` has any length except 0.
 * For another half angle returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_light_cone(int order, const float axis[3], float half_angle, const float radiance[3],
                                  float* light, prt_message* message);
/* Writes to `light` [order*order][3] the light at the origin of a sphere that emits radiance `radiance`.
 * `center` and `radius` are in one unit, such as metres. If the origin is inside the sphere or on it, or
 * `radius` is not positive, returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_light_sphere(int order, const float center[3], float radius, const float radiance[3],
                                    float* light, prt_message* message);
/* Writes to `light` [order*order][3] the light at the origin of a disc that emits radiance `radiance` on the
 * side to which `normal` points. From behind and edge-on the light is black. `normal` has any length except
 * 0. `center` and `radius` are in one unit, such as metres. If `radius` is not positive, returns
 * PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_light_disc(int order, const float center[3], const float normal[3], float radius,
                                  const float radiance[3], float* light, prt_message* message);
/* Writes to `light` [order*order][3] the light whose radiance is `top` from direction `up` and `bottom` from
 * direction -`up`, and changes between these linearly in the cosine of the angle to `up`. `up` has any length
 * except 0. */
PRT_API prt_status prt_light_hemisphere(int order, const float up[3], const float top[3],
                                        const float bottom[3], float* light, prt_message* message);
/* Direction of the center column of a lat-long image: PRT_CENTER_Z is +Z, as in OpenEXR; PRT_CENTER_X is +X,
 * as in three.js, glTF viewers and Blender. */
typedef enum prt_center { PRT_CENTER_Z = 0, PRT_CENTER_X = 1 } prt_center;
/* A lat-long image: columns are longitudes, rows are latitudes, the top row is +Y. The caller owns `pixels`.
 */
typedef struct prt_image {
    int width, height;   /* pixels, each at least 1 */
    const float* pixels; /* [height][width][3] radiance, linear Rec. 709, rows from the top */
} prt_image;
/* Projects a lat-long image into SH and writes the result to `light` [order*order][3]. `center` is a
 * prt_center. `threads`: number of threads, 0: all of the machine. For pixels that are negative or not
 * finite, and for coefficients above 1e18, returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_light_from_lat_long(int order, const prt_image* image, int center, int threads,
                                           float* light, prt_message* message);
/* Loads an environment map (OpenEXR, Radiance HDR; PNG and JPEG clip bright lights), projects it into SH and
 * writes the result to `light` [order*order][3]. `center` is a prt_center, used for lat-long images only. For
 * pixels that are negative or not finite, and for coefficients above 1e18, returns PRT_BAD_FILE. */
PRT_API prt_status prt_light_from_file(int order, const char* path, int center, float* light,
                                       prt_message* message);
/* A sun: a distant disc of uniform radiance. */
typedef struct prt_sun {
    float towards[3];    /* direction from the receiver to the center of the sun; unit length in outputs, any
                            length except 0 in inputs */
    float irradiance[3]; /* irradiance (radiance times sr) of an unoccluded receiver that faces the sun */
    float half_angle;    /* radians, 0..pi/2: angle between the center and the rim; 0: no extent */
} prt_sun;
/* Loads a light file of `prt project` (docs/format.md): writes the first `order` bands of its sky, without
 * the suns, to `sky` [order*order][3], and its suns to `suns`. *count: on entry the number of elements that
 * `suns` can hold, on return the number of suns in the file. If `suns` cannot hold all suns, returns
 * PRT_TOO_SMALL and writes only *count. `suns` may be null: it then holds 0. If the file has fewer than
 * `order` bands, returns PRT_BAD_FILE and writes nothing. */
PRT_API prt_status prt_light_from_light_file(int order, const char* path, float* sky, prt_sun* suns,
                                             size_t* count, prt_message* message);
/* Writes to `light` [order*order][3] the sum of the light of `suns` [count]. The result is the argument
 * `suns` of prt_model_update_constants_separate. `suns` may be null if `count` is 0. */
PRT_API prt_status prt_light_suns(int order, const prt_sun* suns, size_t count, float* light,
                                  prt_message* message);
/* Rotates `light` [order*order][3] in place. `rotation` is a 3x3 rotation matrix R in column-major order:
 * light from direction w then arrives from R w. To light a model that the renderer draws rotated, rotate the
 * light by the inverse of the model's rotation. */
PRT_API prt_status prt_light_rotate(int order, const float rotation[9], float* light, prt_message* message);
/* Removes ringing (negative radiance near bright lights) from `light` [order*order][3] in place: scales its
 * bands by the weakest filter that makes the radiance non-negative in every direction. A channel whose mean
 * radiance is not positive, or is tiny relative to its other coefficients, may remain negative. If the
 * magnitude of a coefficient exceeds 1e37, returns PRT_BAD_ARGUMENT. Intended for lights from images. Call it
 * once per light, before prt_light_rotate. */
PRT_API prt_status prt_light_dering(int order, float* light, prt_message* message);

/* Handle of a model with compressed transfer, in a file that `prt compress` has written. */
typedef struct prt_model prt_model;

/* Loads a model from a .glb file and writes its handle to *model; the caller destroys it with
 * prt_model_destroy. The file must contain all of its data, without Draco compression; prt compress writes
 * such files. For other files returns PRT_BAD_FILE. If loading fails, *model is null. Figures with lobes are
 * left out. */
PRT_API prt_status prt_model_load(const char* path, prt_model** model, prt_message* message);
/* Loads a model from a .glb file in memory, `size` bytes at `bytes`, and writes its handle to *model; the
 * caller destroys it with prt_model_destroy. If loading fails, *model is null. The caller may free `bytes`
 * after the call. */
PRT_API prt_status prt_model_load_memory(const void* bytes, size_t size, prt_model** model,
                                         prt_message* message);
/* Destroys a model, and with it all arrays and names to which the functions of the model returned pointers.
 * `model` may be null. */
PRT_API void prt_model_destroy(prt_model* model);

/* Storage of the weights of a receiver. PRT_FLOAT32: floats, a multiple of four per receiver. PRT_PACKED: the
 * cluster and integer weights of a few bits share 32-bit words. Values 1 and 2 belonged to formats that have
 * been removed. */
typedef enum prt_weight_format { PRT_FLOAT32 = 0, PRT_PACKED = 3 } prt_weight_format;

/* Properties of a model. Names prt_* are inputs of the vertex shader of prt_model_shader. */
typedef struct prt_model_info {
    int order, channels; /* order: number of SH bands of the lighting, 1..10; channels: 3 if any transfer has
                            color, else 1 */
    size_t receivers;    /* number of receivers: the vertices of all meshes */
    size_t clusters;     /* number of clusters */
    size_t rows;         /* number of constants, 4 floats each: per cluster the mean, 3 rows per predictor,
                            then the basis directions */
    prt_weight_format format;   /* storage of `weights` */
    size_t stride;              /* bytes per receiver in `weights` */
    const void* weights;        /* [receivers][stride] bytes: vertex attributes prt_weights_* if `format` is
                                   PRT_FLOAT32, prt_words_* if PRT_PACKED */
    const uint16_t* cluster_of; /* [receivers] index of the cluster: vertex attribute prt_cluster; null if
                                   `format` is PRT_PACKED: the weights contain the index */
    const uint32_t* cluster_table; /* [clusters][4]: the buffer or texture prt_clusters, which the shader
                                      lacks if all clusters have the same layout */
    size_t meshes;                 /* number of meshes, see prt_mesh */
    int has_direct_term;           /* 1 if the constants can exclude the direct light of suns, else 0; see
                                      prt_model_update_constants_separate */
} prt_model_info;
/* Writes the properties of a model to *out. Its pointers are valid as long as the model exists. */
PRT_API prt_status prt_model_get_info(const prt_model* model, prt_model_info* out, prt_message* message);

/* Mesh attributes that the function prt_exit_radiance(position, normal) of the vertex shader reads, and the
 * origins of positions. */
typedef struct prt_vertex_inputs {
    int normals, positions;    /* each 1 if the shader reads this attribute for the light, else 0 */
    float predictor_origin[3]; /* metres: value of PRT_PREDICTOR_ORIGIN in shaders/prt_exit_radiance.glsl for
                                  positions as in prt_mesh; 0 if `positions` is 0 */
    double origin[3];          /* metres, in the world of the file: point to which prt_mesh.positions are
                                  relative */
} prt_vertex_inputs;
/* Writes to *out the mesh attributes that the vertex shader of a model reads. */
PRT_API prt_status prt_model_get_vertex_inputs(const prt_model* model, prt_vertex_inputs* out,
                                               prt_message* message);

/* Writes to *lamps the number of lamps in the transfer of a model: lights and emissive materials of the
 * scene, or groups of these, each with one strength. 0: the transfer contains distant light only. */
PRT_API prt_status prt_model_count_lamps(const prt_model* model, size_t* lamps, prt_message* message);
/* Writes to *name the name of lamp `lamp`, 0 .. number of lamps - 1. The text is valid as long as the model
 * exists. For other indices returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_model_lamp_name(const prt_model* model, size_t lamp, const char** name,
                                       prt_message* message);

/* A mesh of a model: triangles of one material. The positions and normals of a mesh with instances are in the
 * frame of the mesh, those of other meshes in axes of the world. */
typedef struct prt_mesh {
    size_t vertices;        /* number of vertices */
    size_t first_receiver;  /* index of the receiver of vertex 0; vertex i is receiver first_receiver + i.
                               Meshes may share vertices, and then have the same first_receiver */
    const float* positions; /* [vertices][3], metres, relative to prt_vertex_inputs.origin */
    const float* normals;   /* [vertices][3], unit; zero if neither the file nor the triangles define one */
    const float* texcoords; /* [vertices][2], TEXCOORD_0 of the file; null if the file has none */
    size_t indices;         /* length of `index`: 3 per triangle */
    const uint32_t* index;  /* [indices] vertices of the triangles, counter-clockwise seen from the front */
    float base_color[4]; /* factor of the base color, without its texture: linear Rec. 709 and alpha, 0..1 */
} prt_mesh;
/* Writes mesh `mesh`, 0 .. prt_model_info.meshes - 1, to *out. Its pointers are valid as long as the model
 * exists. For other indices returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_model_get_mesh(const prt_model* model, size_t mesh, prt_mesh* out,
                                      prt_message* message);

/* Computes the constants of all clusters under `light` [order*order][3], which includes all suns, with all
 * lamps at strength 1. Writes them to `constants` [prt_model_info.rows][4], (r, g, b, 0) each. `order` must
 * be at least prt_model_info.order and at most 10; further bands are ignored. Allocates nothing. If the
 * magnitude of a coefficient exceeds 1e20, or that of a constant 1e30, returns PRT_BAD_ARGUMENT; `constants`
 * may then have changed. */
PRT_API prt_status prt_model_update_constants(const prt_model* model, int order, const float* light,
                                              float* constants, prt_message* message);
/* Computes the constants of all clusters for a sky, separate suns and strengths of lamps, like
 * prt_model_update_constants. `sky` and `suns` are lights [order*order][3]; `suns` is the result of
 * prt_light_suns, or null: no suns. If prt_model_info.has_direct_term is 1, the constants contain the light
 * of the suns only after a bounce, and the renderer adds their direct light with sharp shadows. If it is 0,
 * the constants contain all light of the suns. `lamps` [number of lamps][3]: strength or color of each lamp,
 * at most 1e20; 1 is as in the scene; null: all 1. */
PRT_API prt_status prt_model_update_constants_separate(const prt_model* model, int order, const float* sky,
                                                       const float* suns, const float* lamps,
                                                       float* constants, prt_message* message);
/* Computes the exit radiance for albedo 1 of all receivers on the CPU, as the vertex shader does, and writes
 * it to `radiance` [receivers][3]. `constants` [rows][4] is the result of prt_model_update_constants. If the
 * magnitude of a constant exceeds 1e30, returns PRT_BAD_ARGUMENT. The first call allocates 12 bytes per
 * receiver and predictor. Uses all threads of the machine. */
PRT_API prt_status prt_model_evaluate(const prt_model* model, const float* constants, float* radiance,
                                      prt_message* message);

/* Shading language of a shader: PRT_GLSL450 for OpenGL 4.5, PRT_GLSL330 for OpenGL 3.3, PRT_ESSL300 for
 * OpenGL ES 3.0 and WebGL 2, PRT_VULKAN for Vulkan (GLSL to compile to SPIR-V). */
typedef enum prt_language { PRT_GLSL450 = 0, PRT_GLSL330 = 1, PRT_ESSL300 = 2, PRT_VULKAN = 3 } prt_language;
/* Storage from which a vertex shader reads the constants and the table of clusters. */
typedef enum prt_constants {
    PRT_CONSTANTS_IN_BUFFER = 0, /* storage buffers; not in PRT_GLSL330 and PRT_ESSL300 */
    PRT_CONSTANTS_IN_BLOCK = 1,  /* uniform blocks; a driver may support no more than 16 KB */
    PRT_CONSTANTS_IN_TEXTURE = 2 /* textures 256 texels wide: RGBA32F constants, RGBA32UI table */
} prt_constants;
/* Writes the source of the vertex shader of a model, with a final 0, to `source`. `language` is a
 * prt_language, `constants` a prt_constants. *size: on entry the size of `source` in bytes; on return the
 * required size, including the final 0. If `source` is null or smaller, returns PRT_TOO_SMALL and writes only
 * *size. If the language does not support this storage, or the weights of the model do not fit into vertex
 * attributes, returns PRT_BAD_ARGUMENT. Inputs of the shader: at location 0 `position`, which is
 * prt_mesh.positions unchanged (the uniform view_projection includes the transform of the model); at location
 * 15 `normal`, which is prt_mesh.normals, if prt_vertex_inputs.normals is 1; from location 4 on the weights,
 * prt_words_* if packed, else prt_weights_*, and then prt_cluster at location 3. */
PRT_API prt_status prt_model_shader(const prt_model* model, int language, int constants, char* source,
                                    size_t* size, prt_message* message);

/* Instances that share the transfer of their mesh, in a file written by prt bake --instances and prt
 * compress. The file stores each mesh once, with positions and normals in the frame of the mesh.
 * Experimental: prt_instances_* may change with any version. */
typedef struct prt_instances_info {
    size_t count;        /* number of instances, sorted by mesh; 0: the model has no instances, and all other
                            members are 0 or null */
    size_t constants;    /* number of constants of all instances together, 4 floats each */
    const float* worlds; /* [count][3][4], rows of the matrix from prt_mesh.positions to the world of the
                            file: vertex attributes world_x, world_y, world_z */
    const float* tables; /* [count][2][4]: vertex attributes instance_0 and instance_1 */
    double max_degrees;  /* maximum angle, in degrees, between the rotation of an instance and the rounded
                            rotation by which its lighting is computed */
} prt_instances_info;
/* Writes the instances of a model to *out. Its pointers are valid as long as the model exists. For a model
 * without instances returns PRT_OK with count 0. */
PRT_API prt_status prt_instances_get_info(const prt_model* model, prt_instances_info* out,
                                          prt_message* message);
/* Writes the range of instances that draw mesh `mesh`: instances *first .. *first + *count - 1. *count is 0
 * if the mesh has no instances and is drawn once, with the constants of the model; in a model without
 * instances it is always 0. For an index out of range in a model with instances returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_instances_of_mesh(const prt_model* model, size_t mesh, size_t* first, size_t* count,
                                         prt_message* message);
/* Lighting of instances or of a volume. The caller owns the arrays. */
typedef struct prt_lighting {
    int order;          /* number of SH bands of `sky` and `suns`, at least that of the model or volume */
    const float* sky;   /* [order*order][3] */
    const float* suns;  /* [order*order][3], result of prt_light_suns; null: no separate suns */
    const float* lamps; /* [lamps of the model or volume][3] strength or color of each lamp; null: all 1 */
    const float* sun;   /* [3] direction to the sun whose visibility the light texture of a volume stores, of
                           any   length except 0; null, or has_direct_term 0: the stored visibility is 0.
                           Instances   ignore it */
} prt_lighting;
/* Computes the constants of all instances under `lighting` and writes them to `constants`
 * [prt_instances_info.constants][4]. The shader of prt_instances_shader reads these instead of the constants
 * of the model. The limits are those of prt_model_update_constants_separate. `threads`: number of threads, 0:
 * all of the machine. For a model without instances returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_instances_update_constants(const prt_model* model, const prt_lighting* lighting,
                                                  int threads, float* constants, prt_message* message);
/* Writes the source of the vertex shader for instances, with a final 0, to `source`. The shader has the
 * inputs of prt_model_shader, and per instance the rows of prt_instances_info.worlds at locations 10 to 12
 * and those of prt_instances_info.tables at locations 13 and 14. `language`, `constants`, `source` and *size
 * are used as in prt_model_shader. Returns PRT_BAD_ARGUMENT for PRT_CONSTANTS_IN_BLOCK, for a model without
 * instances, and for one with more than 24 float weights per vertex. */
PRT_API prt_status prt_instances_shader(const prt_model* model, int language, int constants, char* source,
                                        size_t* size, prt_message* message);

/* Handle of a volume of probes, in a file that `prt compress` has written. A volume lights objects that move
 * through the scene. Experimental: prt_volume_* may change with any version. */
typedef struct prt_volume prt_volume;

/* Loads the volume in a .glb file, as prt_model_load, and writes its handle to *volume; the caller destroys
 * it with prt_volume_destroy. If loading fails, *volume is null. */
PRT_API prt_status prt_volume_load(const char* path, prt_volume** volume, prt_message* message);
/* Loads the volume in a .glb file in memory, `size` bytes at `bytes`, and writes its handle to *volume; the
 * caller destroys it with prt_volume_destroy. If loading fails, *volume is null. The caller may free `bytes`
 * after the call. */
PRT_API prt_status prt_volume_load_memory(const void* bytes, size_t size, prt_volume** volume,
                                          prt_message* message);
/* Destroys a volume, and with it all arrays to which the functions of the volume returned pointers. `volume`
 * may be null. */
PRT_API void prt_volume_destroy(prt_volume* volume);

/* Properties of a volume. */
typedef struct prt_volume_info {
    int order;           /* number of SH bands of the lighting, 1..10 */
    int incident_order;  /* n = 2..4: the light at a probe has n*n coefficients */
    size_t probes;       /* number of probes */
    size_t rows;         /* number of constants, 4 floats each */
    size_t lamps;        /* number of lamps, each with one strength */
    int has_direct_term; /* 1 if the constants can exclude the direct light of suns, else 0; see
                            prt_model_update_constants_separate */
    float corner[3];     /* metres: minimum corner of the box of the volume, relative to `origin` */
    float spacing;       /* metres: distance of neighbouring probes of the finest level */
    double origin[3];    /* metres, in the world of the file: point to which all positions in prt_volume_*
                            are relative */
} prt_volume_info;
/* Writes the properties of a volume to *out. */
PRT_API prt_status prt_volume_get_info(const prt_volume* volume, prt_volume_info* out, prt_message* message);

/* The three 3D textures that shaders/prt_volume.glsl reads. prt_volume_light: RGBA16F, linear filtering,
 * clamped to the edge, texels by prt_volume_update_light. prt_volume_visibility (visibility distances of
 * probes) and prt_volume_index (the brick at each position): integer texels, not filtered; they do not depend
 * on the lighting. Pointers are valid as long as the volume exists. */
typedef struct prt_volume_textures {
    int light[3], visibility[3], index[3]; /* width, height and depth of each texture in texels */
    size_t light_bytes;                    /* size of the texels of the light texture */
    const uint32_t* visibility_texels;     /* [depth][height][width][2], RG32UI */
    const uint32_t* index_texels;          /* [depth][height][width], R32UI */
} prt_volume_textures;
/* Writes the sizes and texels of the textures of a volume to *out. */
PRT_API prt_status prt_volume_get_textures(const prt_volume* volume, prt_volume_textures* out,
                                           prt_message* message);

/* Computes the constants of a volume under `lighting` and writes them to `constants`
 * [prt_volume_info.rows][4]. Separate suns work as in prt_model_update_constants_separate. Allocates nothing.
 * If the magnitude of a coefficient or strength exceeds 1e20, or that of a constant 1e30, returns
 * PRT_BAD_ARGUMENT; `constants` may then have changed. */
PRT_API prt_status prt_volume_update_constants(const prt_volume* volume, const prt_lighting* lighting,
                                               float* constants, prt_message* message);
/* Computes the texels of the light texture for probes `first` to `last` - 1, and writes them at their
 * positions in `texels`, which holds the whole texture [prt_volume_textures.light_bytes]; other texels do not
 * change. `constants` is the result of prt_volume_update_constants. Several threads may process different
 * probes at once. Allocates nothing. If `first` exceeds `last`, `last` exceeds prt_volume_info.probes, or the
 * magnitude of a constant exceeds 1e30, returns PRT_BAD_ARGUMENT. */
PRT_API prt_status prt_volume_update_light(const prt_volume* volume, const float* constants, size_t first,
                                           size_t last, void* texels, prt_message* message);
/* Computes the incident light at all probes and writes it to `incident` [probes][n*n][3], n =
 * prt_volume_info.incident_order, for lookups on the CPU. `constants` is the result of
 * prt_volume_update_constants. If the magnitude of a constant exceeds 1e30, returns PRT_BAD_ARGUMENT. Uses
 * all threads of the machine. */
PRT_API prt_status prt_volume_evaluate(const prt_volume* volume, const float* constants, float* incident,
                                       prt_message* message);

/* A position to light: `position` in metres, relative to prt_volume_info.origin, and `normal`, the unit
 * normal of the surface at this position, or zero if there is no surface. */
typedef struct prt_volume_position {
    float position[3], normal[3];
} prt_volume_position;
/* Interpolates the incident light at `position` and writes its coefficients to `light` [n*n][3], n =
 * prt_volume_info.incident_order. `incident` is the result of prt_volume_evaluate. Probes that a surface
 * hides from the position have almost no weight. With a normal the lookup uses a point in front of the
 * surface, a quarter of a cell along the normal. A position outside the volume is moved to its boundary. If
 * the light of a probe that is used exceeds 1e30 in magnitude, returns PRT_BAD_ARGUMENT. Allocates
 * nothing. */
PRT_API prt_status prt_volume_incident(const prt_volume* volume, const float* incident,
                                       const prt_volume_position* position, float* light,
                                       prt_message* message);
/* Computes the irradiance of a surface at `position`, divided by pi; times the albedo, this is the exit
 * radiance. Negative channels become 0. position->normal must have length 1 within 1 %, else returns
 * PRT_BAD_ARGUMENT. The lookup at `position`, `incident` and its limit are those of prt_volume_incident.
 * Allocates nothing. */
PRT_API prt_status prt_volume_irradiance(const prt_volume* volume, const float* incident,
                                         const prt_volume_position* position, float irradiance[3],
                                         prt_message* message);

/* Writes the source of the GLSL functions that look up a volume in its textures (shaders/prt_volume.glsl),
 * with a final 0, to `source`. Insert this text after the version line of a shader in any prt_language; in
 * OpenGL ES also after the line `precision highp float;`. Positions in the shader are relative to
 * prt_volume_info.origin. `source` and *size are used as in prt_model_shader. */
PRT_API prt_status prt_volume_functions(const prt_volume* volume, char* source, size_t* size,
                                        prt_message* message);
/* Writes the source of the compute shader that computes the light texture on the GPU
 * (shaders/prt_texels.comp), with a final 0, to `source`. `language` is PRT_GLSL450 or PRT_VULKAN; for others
 * returns PRT_BAD_ARGUMENT. `source` and *size are used as in prt_model_shader. */
PRT_API prt_status prt_volume_shader(const prt_volume* volume, int language, char* source, size_t* size,
                                     prt_message* message);

#ifdef __cplusplus
}
#endif

#endif
