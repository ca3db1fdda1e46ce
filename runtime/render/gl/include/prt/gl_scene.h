#pragma once

#include "prt/gl_lightmap.h"
#include "prt/gl_objects.h"
#include "prt/picture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Vertex array objects, one for each of Scene::vertex_arrays.
using GlVertexArrays = std::vector<GlObject>;

/// Triangles [first, first + count) of a primitive.
struct TriangleRange {
    std::uint32_t first, count;
};

/// How much of the light that meets a surface it stops.
enum class Blocking { nothing, all, part };

/// The geometry, textures and materials of a scene on the GPU, for any program whose fragment shader includes
/// `shaders/surface.glsl` (and `sun_light.glsl` for suns, `emission.glsl` for what shines). A context must be
/// current.
class GlScene {
public:
    /// Keeps a reference to `scene`. `textures`: load_textures(scene). Throws `Error` when memory runs out.
    GlScene(const Scene& scene, std::span<const Texture> textures);

    const Scene& scene() const { return scene_; }
    /// With positions, colors and normals at their locations.
    GlVertexArrays make_vertex_arrays() const;
    /// Points attribute `location` of all `arrays` at `components` floats per receiver in `buffer`.
    void attach_receivers(const GlVertexArrays& arrays, const GlObject& buffer, std::uint32_t location,
                          int components) const;

    /// From now on the emission of each material is multiplied with this, [materials]; empty: nothing shines.
    void shine(std::span<const glm::vec3> strengths) { emission_.assign(strengths.begin(), strengths.end()); }

    /// From now on surfaces are lit by these, which programs with PRT_LIGHTMAP look up.
    void light_by(const GlLightmapTextures& lightmaps) { lightmaps_ = lightmaps; }

    /// Drawn after all others, far ones first, without writing depth.
    bool is_blended(const Primitive& primitive) const;
    /// Draws `primitive` with `program`, which is in use; all of it, or some of its triangles.
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
              std::span<const TriangleRange> ranges) const;
    /// Draws so many instances of it; attributes that step from one to the next are those of `arrays`.
    void draw_instances(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
                        std::size_t count) const;
    Blocking blocking(const Primitive& primitive) const;
    /// Draws both sides of `primitive` with a program of sun_caster.vert and sun_caster.frag, in use.
    void draw_caster(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    /// The blended primitives, far ones first.
    std::vector<std::size_t> blended_from_far(const glm::vec3& position) const;
    std::size_t bytes() const { return bytes_; }

private:
    struct Vertices {
        GlObject positions, normals, colors;
        std::vector<GlObject> texcoords; ///< [set]; none where the file has none
    };
    /// Where a material has a texture, and vertices have coordinates for it.
    const GlObject* texture_of(const TextureUse& use, const Vertices& vertices) const;
    void prepare(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    void prepare_for_suns(const GlObject& program, const Primitive& primitive) const;
    void prepare_emission(const GlObject& program, const Primitive& primitive) const;
    void prepare_lightmap(std::uint32_t array, std::size_t primitive) const;

    const Scene& scene_;
    std::vector<Vertices> vertices_;  ///< [vertex arrays]
    std::vector<GlObject> indices_;   ///< [primitives]
    std::vector<glm::vec3> centers_;  ///< [primitives] mean of a corner of each triangle
    std::vector<GlObject> textures_;  ///< [images]
    std::vector<bool> encoded_;       ///< [images] as colors
    std::vector<glm::vec3> emission_; ///< [materials]; empty: none shines
    GlLightmapTextures lightmaps_;
    std::size_t bytes_ = 0;
};

/// An immutable texture without pixels. Throws `Error` when memory runs out.
GlObject make_texture_2d(int levels, std::uint32_t format, int width, int height);
/// A lat-long picture for background.frag.
GlObject make_background(const Image& image);

} // namespace prt
