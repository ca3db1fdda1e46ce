#pragma once

// A flattened glTF scene: vertices and triangles of the default scene in the world's frame, with materials
// and lights, ready for baking and rendering; skinning data of its vertices. `load_model`
// (prt/load/model.h) and `extract_scene` (prt/gltf/gltf.h) read scenes. Stable.

#include "prt/core/glm_layout.h"

#include <glm/mat3x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Maximum magnitude of each coordinate of a vertex in the file's world, metres. Functions that read scenes
/// reject vertices beyond it. The limit ensures that floats can represent all quantities derived from
/// positions; the largest is the square of twice a triangle's area, (2 sqrt(3) 1e9)^4 = 1.4e38.
inline constexpr double kFarthestVertex = 1e9;

/// Meaning of the alpha of a surface, as in glTF. Alpha is the product of the alphas of the base color, its
/// texture and the vertex colors.
enum class AlphaMode {
    opaque, ///< alpha is ignored
    mask,   ///< the surface is opaque where alpha is at least Material::alpha_cutoff, and absent elsewhere
    blend   ///< alpha is the fraction of light that the surface blocks, 0..1
};
/// Texels that a surface shows at texture coordinates outside 0..1.
enum class Wrap {
    repeat, ///< copies of the texture
    mirror, ///< copies of the texture; every second one is mirrored
    clamp   ///< the texels at the border of the texture
};

/// Reference from a material to a texture, which multiplies factors of the material. All texels count as 1 if
/// `image` is -1, or if a vertex array lacks the set of texture coordinates.
struct TextureUse {
    int image = -1;   ///< index into Scene::images; -1: no texture
    int texcoord = 0; ///< index of the set in VertexArray::texcoords
    /// Matrix of KHR_texture_transform. Its product with (u, v, 1) of a vertex is the position in the
    /// texture.
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0};
    Wrap wrap_u = Wrap::repeat, ///< wrapping of the first texture coordinate
        wrap_v = Wrap::repeat;  ///< wrapping of the second texture coordinate
};

/// Diffuse transmission of a surface: KHR_materials_diffuse_transmission.
struct DiffuseTransmission {
    float factor = 0;          ///< fraction of the diffuse light that is transmitted, 0..1
    TextureUse factor_texture; ///< its alpha channel multiplies `factor`
    glm::vec3 color{1};        ///< factor on the transmitted light, linear Rec. 709, 0..1
    TextureUse color_texture;  ///< sRGB; multiplies `color`
};

/// Specular transmission of a surface, like window glass: KHR_materials_transmission.
struct Glass {
    /// Fraction of the light that glass transmits, 0..1, before the base color tints it; 0: not glass. The
    /// factor includes 1 - Metal::factor if Metal has no texture.
    float factor = 0;
    TextureUse texture; ///< its red channel multiplies `factor`
};

/// Medium below a surface: KHR_materials_volume. `has_medium` of runtime/load/light_passing.h defines when
/// the medium has an effect.
struct MaterialVolume {
    /// Thickness, not negative, in the mesh's frame. Only zero has a meaning: the surface is a thin sheet
    /// without a medium.
    float thickness = 0;
    /// Distance in metres after which `attenuation_color` remains; infinite: no attenuation.
    float attenuation_distance = std::numeric_limits<float>::infinity();
    glm::vec3 attenuation_color{1}; ///< transmittance over `attenuation_distance`, linear Rec. 709, 0..1
    /// Whether transfer contains light that passes through a medium which the file does not describe
    /// (BakeRecord::media). Functions that read transfer set it.
    bool baked = false;
};

/// Metallic and roughness factors of a surface. Baking uses them to reduce the diffuse reflection of smooth
/// metals.
struct Metal {
    float factor = 0,   ///< metallic factor, 0..1; 0: not a metal
        roughness = 1;  ///< roughness factor, 0..1; 1: a rough metal reflects diffusely
    TextureUse texture; ///< its blue channel multiplies `factor`, its green channel `roughness`
};

/// Light that a surface emits at its front, and at its back if its material is double-sided.
struct Emission {
    /// Radiance, linear Rec. 709, 0..1e9: emissiveFactor times the strength of
    /// KHR_materials_emissive_strength. 0: the surface does not emit light.
    glm::vec3 radiance{0};
    TextureUse texture; ///< sRGB; multiplies `radiance`
};

/// Material of a surface. Functions that read scenes clamp factors and colors to 0..1, except
/// Emission::radiance. The default is white, diffuse and opaque.
struct Material {
    std::string name;                         ///< name in the file; may be empty
    glm::vec4 base_color{1};                  ///< linear Rec. 709 and alpha, 0..1
    TextureUse base_color_texture;            ///< sRGB and alpha; multiplies `base_color`
    Metal metal;                              ///< metallic and roughness factors
    AlphaMode alpha_mode = AlphaMode::opaque; ///< meaning of alpha
    float alpha_cutoff = 0.5f;                ///< minimum alpha of opaque points for AlphaMode::mask
    bool double_sided = false;                ///< whether the surface is visible from its back also
    /// Whether surfaces of this material block rays. Not part of glTF; true unless a caller changes it. False
    /// is for sky domes and outline shells around a scene.
    bool casts_shadow = true;
    DiffuseTransmission transmission; ///< diffuse transmission; default: none
    Glass glass;                      ///< specular transmission; default: none
    MaterialVolume volume;            ///< medium below the surface; default: none
    Emission emission;                ///< emitted light; default: none
};

/// Vertices of one primitive, or of several primitives of one node that share them. Each vertex is a
/// receiver.
struct VertexArray {
    std::vector<glm::vec3> positions; ///< [vertices] metres, in the world's axes, relative to Scene::origin
    std::vector<glm::vec3> normals;   ///< [vertices] unit, in the world's axes; zero if neither the file nor
                                      ///< the triangles define one
    std::vector<std::vector<glm::vec2>> texcoords; ///< [set n][vertices] TEXCOORD_n, up to the first set that
                                                   ///< the file lacks; an empty set counts as missing
    std::vector<glm::vec4> colors; ///< [vertices] COLOR_0, linear Rec. 709 and alpha, 0..1; empty: white
    /// [vertices] index in the file of the vertex from which each vertex was created, if flat normals split
    /// vertices; empty: the indices are the same as in the file.
    std::vector<std::uint32_t> source;
    std::size_t first_receiver = 0; ///< index of the receiver of vertex 0; vertex v is receiver
                                    ///< first_receiver + v
    /// Whether the file has lobes for these vertices (prt/core/lobes.h). They then have no transfer: that of
    /// their receivers is 0 if it is raw, and undefined if it is compressed.
    bool lobes = false;

    /// Returns the number of vertices.
    std::size_t size() const { return positions.size(); }
};

/// A primitive of a node: triangles with one material.
struct Primitive {
    int node = 0,             ///< index in the nodes of the file; nodes that reading adds follow these
        mesh = 0,             ///< index in the meshes of the file
        primitive = 0;        ///< index in the primitives of this mesh
    std::size_t vertices = 0; ///< index into Scene::vertex_arrays
    std::size_t material = 0; ///< index into Scene::materials
    bool mirrored = false;    ///< true: the transform of the node, which has no skin, mirrors; the winding
                              ///< order of `triangles` is then reversed relative to the file
    std::vector<glm::uvec3> triangles; ///< indices of vertices in the vertex array, counter-clockwise seen
                                       ///< from the front
    std::string node_name = {};        ///< name of the node, for messages; "node N" if the node has no name
};

/// Type of a light of KHR_lights_punctual.
enum class PunctualKind {
    point,      ///< emits equally in all directions from a position
    spot,       ///< emits from a position into a cone
    directional ///< distant light from one direction
};

/// A light of KHR_lights_punctual in the world.
struct PunctualLight {
    std::string name; ///< name of the node with the light, else of the light, else "light N"
    PunctualKind kind = PunctualKind::point; ///< type of the light
    /// Color times intensity, linear Rec. 709: irradiance on a surface that faces the light, at a distance of
    /// one metre for point and spot lights (inside the inner cone), at every distance for directional lights.
    glm::vec3 intensity{1};
    glm::vec3 position{0};         ///< metres, relative to Scene::origin; not used by directional lights
    glm::vec3 direction{0, 0, -1}; ///< unit vector along which the light shines; not used by point lights
    float range = std::numeric_limits<float>::infinity(); ///< metres; the light is zero from this distance
                                                          ///< on; infinite: no limit; not used by
                                                          ///< directional lights
    float inner_cone = 0,       ///< spot lights: angle from `direction` up to which the intensity is full,
                                ///< radians, at most `outer_cone`
        outer_cone = 0.785398f; ///< spot lights: angle from `direction` from which on the intensity is zero,
                                ///< radians, at most pi/2
};

/// An image in its file format: PNG, JPEG, WebP, AVIF or another format.
struct EncodedImage {
    std::string name;             ///< for messages: "image 3 'wood.png'"; "image 3" if it has no name
    std::vector<std::byte> bytes; ///< content of the image file; empty: the image cannot be read
    /// Reason why the image cannot be read, for the message of an `Error` of code that needs the pixels; may
    /// be empty.
    std::string trouble = {};
};

/// A flattened scene.
struct Scene {
    /// Center of the bounding box of all triangles in the file's world, metres. All positions are relative to
    /// this center, so that a scene far from the world's origin keeps its precision.
    glm::dvec3 origin{0};
    /// Vertices of `primitives`. Receivers are numbered array by array.
    std::vector<VertexArray> vertex_arrays;
    std::vector<Primitive> primitives; ///< triangle primitives of visible nodes, node by node
    std::vector<Material> materials;   ///< materials of the file, then a default `Material` for primitives
                                       ///< without a material
    std::vector<EncodedImage> images;  ///< images of the file, then empty ones for textures without an image
    std::vector<PunctualLight> lights; ///< one for each visible node with a light of KHR_lights_punctual
    std::vector<std::string> notices;  ///< messages for the user about how the file was read, one line each

    /// Converts `position` in metres, relative to `origin`, to a position in metres in the file's world.
    glm::dvec3 world(const glm::vec3& position) const { return origin + glm::dvec3(position); }
    /// Returns the number of receivers: the number of vertices of all vertex arrays.
    std::size_t receivers() const;
    /// Returns the number of triangles of all primitives.
    std::size_t triangles() const;
};

/// Joints of a skinned mesh.
struct Skin {
    std::vector<std::size_t> joints; ///< indices of the joint nodes in the file
    /// [joints] matrix from the frame of the unposed mesh to the frame of the joint; identity if the file has
    /// no inverse bind matrices.
    std::vector<glm::dmat4> inverse_bind;
};

/// Skinning data of one element of `Scene::vertex_arrays`. With a skin, the weighted mean of several matrices
/// transforms each vertex. Without a skin, the world matrix of the node transforms all vertices.
struct MovingVertices {
    std::size_t node = 0; ///< index in the file of the node that draws the vertices
    int skin = -1;        ///< index into AnimatedScene::skins of prt/gltf/animation.h; -1: no skin
    /// [vertices] positions and unit normals in the frame of the mesh: before node and joint matrices, after
    /// morph targets. A normal is 0 if it is undefined.
    std::vector<glm::vec3> positions, normals;
    std::size_t influences = 1; ///< number of matrices per vertex
    /// [vertices][influences] indices into the result of AnimatedScene::matrices for this array. Empty
    /// without a skin.
    std::vector<std::uint32_t> matrices;
    /// [vertices][influences] weight of each matrix, 0 or more; the sum per vertex is above 0, but may differ
    /// from 1. Weight 0: ignore the matrix index. Empty without a skin.
    std::vector<float> weights;
    bool morphs = false; ///< whether the file has morph targets for the vertices
};

/// Returns the matrix from the frame of the mesh to the world for one vertex: with a skin, the weighted mean
/// of its matrices. `palette`: result of AnimatedScene::matrices for the array of `moving`. `vertex`: index
/// into moving.positions.
glm::dmat4 vertex_matrix(std::span<const glm::dmat4> palette, const MovingVertices& moving,
                         std::size_t vertex);

/// Returns the lamp name of an emissive material: its name, or "material N" if it has no name. `material`:
/// index N into Scene::materials.
std::string lamp_name(const Scene& scene, std::size_t material);

/// Returns the area of each receiver in m², [receivers]: a third of the total area of the triangles that use
/// the vertex. The sum is the area of all triangles, each counted once.
std::vector<float> receiver_areas(const Scene& scene);

/// Returns a hash of the positions (relative to Scene::origin) and normals of all receivers, as 16
/// hexadecimal digits. The hash does not depend on the order of the receivers or on Scene::origin. Scenes
/// with equal hashes have the same receivers, except for improbable collisions.
std::string receivers_id(const Scene& scene);

/// An axis-aligned bounding box, metres, relative to Scene::origin.
struct Bounds {
    glm::vec3 low, ///< minimum corner
        high;      ///< maximum corner
};
/// Returns the bounding box of all triangles. If the scene has no triangles, `low` is +infinity and `high` is
/// -infinity.
Bounds bounds(const Scene& scene);
/// Returns the bounding box of the triangles of one primitive of `scene`. If the primitive has no triangles,
/// `low` is +infinity and `high` is -infinity.
Bounds bounds(const Scene& scene, const Primitive& primitive);

} // namespace prt
