#pragma once

// A flattened glTF scene: world-space vertices and triangles of the default scene, ready for baking and
// rendering. Stable.

#include "prt/support/glm_layout.h"

#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace prt {

/// Maximum distance of a vertex from the world's origin along each axis, metres. Up to this distance, floats
/// can represent all quantities derived from positions. The largest is the square of twice a triangle's area,
/// (2 sqrt(3) 1e9)^4 = 1.4e38. Doubles resolve a tenth of a micrometre at that distance. `extract_scene`
/// rejects vertices beyond it.
inline constexpr double kFarthestVertex = 1e9;

/// Alpha mode of a material, as in glTF.
enum class AlphaMode { opaque, mask, blend };
/// Wrapping of texture coordinates outside 0..1.
enum class Wrap { repeat, mirror, clamp };

/// Texture reference of a material.
struct TextureUse {
    int image = -1; ///< index into Scene::images; -1: none
    int texcoord = 0;
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0}; ///< KHR_texture_transform
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

/// Diffuse transmission of a surface: KHR_materials_diffuse_transmission.
struct DiffuseTransmission {
    float factor = 0;          ///< fraction of the diffuse light that is transmitted, 0..1
    TextureUse factor_texture; ///< in the alpha channel
    glm::vec3 color{1};        ///< linear Rec. 709
    TextureUse color_texture;
};

/// Specular transmission of a surface, like window glass: KHR_materials_transmission.
struct Glass {
    float factor = 0;   ///< fraction of the non-metallic light that is transmitted, 0..1
    TextureUse texture; ///< factor in the red channel
};

/// Medium below a surface: KHR_materials_volume.
struct MaterialVolume {
    float thickness = 0;                                                 ///< 0: a thin sheet without a medium
    float attenuation_distance = std::numeric_limits<float>::infinity(); ///< metres
    glm::vec3 attenuation_color{1};                                      ///< transmittance over that distance
};

/// Metallic and roughness factors.
struct Metal {
    float factor = 0, roughness = 1;
    TextureUse texture; ///< factors: metallic in blue, roughness in green
};

/// Light that a surface emits at its front, and at its back if it is double-sided: emissiveFactor times
/// KHR_materials_emissive_strength.
struct Emission {
    glm::vec3 radiance{0}; ///< linear Rec. 709
    TextureUse texture;    ///< sRGB, a factor
};

/// Material of a surface. All factors are in 0..1, as glTF requires.
struct Material {
    std::string name;
    glm::vec4 base_color{1}; ///< linear Rec. 709 and alpha
    TextureUse base_color_texture;
    Metal metal;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    /// Whether surfaces of this material block rays. Not part of glTF. False for sky domes and outline shells
    /// around a scene.
    bool casts_shadow = true;
    DiffuseTransmission transmission;
    Glass glass;
    MaterialVolume volume;
    Emission emission;
};

/// Vertices of one or several primitives of one node. Each vertex is a receiver.
struct VertexArray {
    std::vector<glm::vec3> positions;              ///< metres, relative to Scene::origin
    std::vector<glm::vec3> normals;                ///< unit; zero if neither the file nor the triangles
                                                   ///< define one
    std::vector<std::vector<glm::vec2>> texcoords; ///< [set][vertex]; empty for a set that the file lacks
    std::vector<glm::vec4> colors;                 ///< COLOR_0, linear, 0..1; empty: white
    /// [vertices] index of the vertex in the file from which each vertex was created, if flat normals split
    /// vertices; empty: the same indices as in the file.
    std::vector<std::uint32_t> source;
    std::size_t first_receiver = 0;

    std::size_t size() const { return positions.size(); }
};

/// A primitive of a node: triangles with one material.
struct Primitive {
    int node = 0, mesh = 0, primitive = 0; ///< indices in the file
    std::size_t vertices = 0;              ///< index into Scene::vertex_arrays
    std::size_t material = 0;              ///< index into Scene::materials
    bool mirrored = false;                 ///< the node's transform mirrors; the winding order of the
                                           ///< triangles has been reversed
    std::vector<glm::uvec3> triangles;     ///< counter-clockwise from the front, indices into the vertex
                                           ///< array
    std::string node_name = {};            ///< for messages; "node N" if the file has none
};

/// Type of a light of KHR_lights_punctual.
enum class PunctualKind { point, spot, directional };

/// A light of KHR_lights_punctual in the world.
struct PunctualLight {
    std::string name; ///< name of its node, else of the light; "light N" if neither has one
    PunctualKind kind = PunctualKind::point;
    glm::vec3 intensity{1}; ///< linear Rec. 709: irradiance at a distance of one metre; for directional
                            ///< lights irradiance everywhere
    glm::vec3 position{0};  ///< metres, relative to Scene::origin
    glm::vec3 direction{0, 0, -1};                        ///< unit, direction of emission
    float range = std::numeric_limits<float>::infinity(); ///< metres, end of its influence
    float inner_cone = 0, outer_cone = 0.785398f; ///< radians from the axis: angle at which full intensity
                                                  ///< ends, and angle from which on the intensity is zero
};

/// An image as stored in its file format.
struct EncodedImage {
    std::string name;             ///< for messages
    std::vector<std::byte> bytes; ///< empty: cannot be read
    /// Reason why it cannot be read; the message of the `Error` for code that needs the pixels.
    std::string trouble = {};
};

/// A flattened scene.
struct Scene {
    /// Center of the scene's bounding box in the file's world, metres. All positions are relative to it, so
    /// that a scene far from the world's origin keeps its precision.
    glm::dvec3 origin{0};
    std::vector<VertexArray> vertex_arrays;
    std::vector<Primitive> primitives;
    std::vector<Material> materials; ///< materials of the file, then glTF's default material
    std::vector<EncodedImage> images;
    std::vector<PunctualLight> lights;
    std::vector<std::string> notices; ///< messages for the user about how the file was read, one line each

    /// Converts `position`, relative to `origin`, to the file's world.
    glm::dvec3 world(const glm::vec3& position) const { return origin + glm::dvec3(position); }
    /// Returns the number of receivers: vertices of all vertex arrays.
    std::size_t receivers() const;
    /// Returns the number of triangles of all primitives.
    std::size_t triangles() const;
};

/// Returns the lamp name of an emissive material: its name, or "material N" if it has none.
std::string lamp_name(const Scene& scene, std::size_t material);

/// Returns the area of each receiver, a third of the area of its triangles, in m²: [receivers].
std::vector<float> receiver_areas(const Scene& scene);

/// Returns a hexadecimal hash of the positions (relative to the scene's origin) and normals of all receivers,
/// independent of their order. Transfers with equal hashes belong to the same receivers.
std::string receivers_id(const Scene& scene);

/// Corners of an axis-aligned bounding box, relative to the scene's origin.
struct Bounds {
    glm::vec3 low, high;
};
/// Returns the bounding box of all triangles.
Bounds bounds(const Scene& scene);
/// Returns the bounding box of one primitive; inverted and infinite if it has no triangle.
Bounds bounds(const Scene& scene, const Primitive& primitive);

} // namespace prt
