#pragma once

// A glTF scene, flattened: world-space vertices and triangles of the default scene, ready to bake and to
// draw. Stable.

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

/// The farthest that a vertex may lie from the world's origin along each axis, metres. Up to there floats
/// hold what is made of positions: the most is the square of a triangle's doubled area, (2 sqrt(3) 1e9)^4
/// = 1.4e38. Doubles place vertices to a tenth of a micrometre there. `extract_scene` refuses what lies
/// beyond.
inline constexpr double kFarthestVertex = 1e9;

enum class AlphaMode { opaque, mask, blend };
enum class Wrap { repeat, mirror, clamp };

/// A texture as a material uses it.
struct TextureUse {
    int image = -1; ///< index into Scene::images, -1: none
    int texcoord = 0;
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0}; ///< KHR_texture_transform
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

/// Light that a surface lets through diffusely: KHR_materials_diffuse_transmission.
struct DiffuseTransmission {
    float factor = 0;          ///< share of the diffuse light that passes, 0..1
    TextureUse factor_texture; ///< in alpha
    glm::vec3 color{1};        ///< linear Rec. 709
    TextureUse color_texture;
};

/// Light that a surface lets through straight, like window glass: KHR_materials_transmission.
struct Glass {
    float factor = 0;   ///< share of the light that is not reflected by metal, 0..1
    TextureUse texture; ///< times red
};

/// What is under a surface: KHR_materials_volume.
struct Volume {
    float thickness = 0;                                                 ///< 0: a thin sheet, nothing inside
    float attenuation_distance = std::numeric_limits<float>::infinity(); ///< metres
    glm::vec3 attenuation_color{1};                                      ///< what is left after that distance
};

/// How metallic a surface is, and how rough.
struct Metal {
    float factor = 0, roughness = 1;
    TextureUse texture; ///< times blue, times green
};

/// Light that a surface gives off at its front, and at its back where it is double-sided: emissiveFactor
/// times KHR_materials_emissive_strength.
struct Emission {
    glm::vec3 radiance{0}; ///< linear Rec. 709
    TextureUse texture;    ///< sRGB, a factor
};

/// All factors lie in 0..1, as glTF wants them.
struct Material {
    std::string name;
    glm::vec4 base_color{1}; ///< linear Rec. 709 and alpha
    TextureUse base_color_texture;
    Metal metal;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    /// Its surfaces stop rays. Not part of glTF: for skies and outlines that are shells round a scene.
    bool casts_shadow = true;
    DiffuseTransmission transmission;
    Glass glass;
    Volume volume;
    Emission emission;
};

/// Vertices of one or several primitives of one node. Each vertex is a receiver.
struct VertexArray {
    std::vector<glm::vec3> positions;              ///< metres, seen from Scene::origin
    std::vector<glm::vec3> normals;                ///< unit; zero where neither file nor triangles give one
    std::vector<std::vector<glm::vec2>> texcoords; ///< [set][vertex]; a set that the file lacks is empty
    std::vector<glm::vec4> colors;                 ///< COLOR_0, linear, 0..1; empty: white
    /// Index of the file's vertex that each vertex came from, where flat normals split some; empty: the same.
    std::vector<std::uint32_t> source;
    std::size_t first_receiver = 0;

    std::size_t size() const { return positions.size(); }
};

struct Primitive {
    int node = 0, mesh = 0, primitive = 0; ///< indices in the file
    std::size_t vertices = 0;              ///< index into Scene::vertex_arrays
    std::size_t material = 0;              ///< index into Scene::materials
    bool mirrored = false;                 ///< the node's transform mirrors, so triangles were turned round
    std::vector<glm::uvec3> triangles;     ///< counter-clockwise from the front, into the vertex array
    std::string node_name = {};            ///< for messages; "node N" where the file has none
};

enum class PunctualKind { point, spot, directional };

/// A light of KHR_lights_punctual in the world.
struct PunctualLight {
    std::string name; ///< of its node, else its own; "light N" where neither has one
    PunctualKind kind = PunctualKind::point;
    glm::vec3 intensity{1};        ///< linear Rec. 709; irradiance at one metre, or at all where directional
    glm::vec3 position{0};         ///< metres, seen from Scene::origin
    glm::vec3 direction{0, 0, -1}; ///< unit, the way that it shines
    float range = std::numeric_limits<float>::infinity(); ///< metres, where it ends
    float inner_cone = 0, outer_cone = 0.785398f;         ///< radians from the middle: full, and ended
};

struct EncodedImage {
    std::string name;             ///< for messages
    std::vector<std::byte> bytes; ///< empty: cannot be read
    std::string trouble = {};     ///< why it cannot be read; throw it where its pixels are needed
};

struct Scene {
    /// The middle of the scene's box in the file's world, metres. Positions are seen from here, so that a
    /// scene far from the world's origin loses no digits.
    glm::dvec3 origin{0};
    std::vector<VertexArray> vertex_arrays;
    std::vector<Primitive> primitives;
    std::vector<Material> materials; ///< the file's, then glTF's default material
    std::vector<EncodedImage> images;
    std::vector<PunctualLight> lights;
    std::vector<std::string> notices; ///< what a user should know about how the file was read, a line each

    /// Where a position lies in the file's world.
    glm::dvec3 world(const glm::vec3& position) const { return origin + glm::dvec3(position); }
    std::size_t receivers() const;
    std::size_t triangles() const;
};

/// The lamp that a material which shines belongs to: its name, or "material N" where it has none.
std::string lamp_name(const Scene& scene, std::size_t material);

/// A third of the area of the triangles at each receiver, in m². [receivers]
std::vector<float> receiver_areas(const Scene& scene);

/// Hexadecimal hash of the positions (from the scene's origin) and normals of all receivers, in any order:
/// transfers belong together when it is equal.
std::string receivers_id(const Scene& scene);

/// Corners of the box round all triangles, seen from the scene's origin.
struct Bounds {
    glm::vec3 low, high;
};
Bounds bounds(const Scene& scene);
/// Of one of its primitives; infinite the wrong way round where that has no triangle.
Bounds bounds(const Scene& scene, const Primitive& primitive);

} // namespace prt
