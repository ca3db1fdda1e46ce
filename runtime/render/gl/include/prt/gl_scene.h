#pragma once

// Scenes on the GPU.

#include "prt/gl_lightmap.h"
#include "prt/gl_objects.h"
#include "prt/picture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Vertex array objects, one per entry of Scene::vertex_arrays.
using GlVertexArrays = std::vector<GlObject>;

/// Triangles [first, first + count) of a primitive.
struct TriangleRange {
    std::uint32_t first, count;
};

/// Part of the incident light that a surface blocks: `term` means that it blocks some of the light.
enum class Blocking { nothing, all, term };

/// Geometry, textures and materials of a scene on the GPU, for any program whose fragment shader includes
/// `shaders/surface.glsl` (and `sun_light.glsl` for suns, `emission.glsl` for emission). A context must be
/// current.
class GlScene {
public:
    /// Keeps a reference to `scene`. `textures`: load_textures(scene). Throws `Error` if memory runs out.
    GlScene(const Scene& scene, std::span<const Texture> textures);

    const Scene& scene() const { return scene_; }
    /// Creates vertex arrays with positions, colors and normals at their locations.
    GlVertexArrays make_vertex_arrays() const;
    /// Binds attribute `location` of all `arrays` to `components` floats per receiver in `buffer`.
    void attach_receivers(const GlVertexArrays& arrays, const GlObject& buffer, std::uint32_t location,
                          int components) const;

    /// Sets the factor on the emission of each material, [materials], for subsequent draws; empty: no
    /// emission.
    void shine(std::span<const glm::vec3> strengths) { emission_.assign(strengths.begin(), strengths.end()); }

    /// Sets the lightmaps of surfaces for subsequent draws with PRT_LIGHTMAP.
    void light_by(const GlLightmapTextures& lightmaps) { lightmaps_ = lightmaps; }

    /// Returns whether `primitive` is drawn after all opaque ones, from far to near, without writing depth.
    bool is_blended(const Primitive& primitive) const;
    /// Draws `primitive` with `program`, which must be in use.
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    /// Draws some triangles of `primitive` with `program`, which must be in use.
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
              std::span<const TriangleRange> ranges) const;
    /// Draws `count` instances of `primitive`; `arrays` must define the per-instance attributes.
    void draw_instances(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
                        std::size_t count) const;
    /// Returns the part of the light of suns that `primitive` blocks.
    Blocking blocking(const Primitive& primitive) const;
    /// Draws both sides of `primitive` into a shadow map. `program`, built from sun_caster.vert and
    /// sun_caster.frag, must be in use.
    void draw_caster(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    /// Returns the blended primitives, sorted from far to near as seen from `position`.
    std::vector<std::size_t> blended_from_far(const glm::vec3& position) const;
    /// Size on the GPU in bytes.
    std::size_t bytes() const { return bytes_; }

private:
    struct Vertices {
        GlObject positions, normals, colors;
        std::vector<GlObject> texcoords; ///< [set]; empty if the file has no such set
    };
    /// Returns the texture, or null if the material has no texture or the vertices have no coordinates for
    /// it.
    const GlObject* texture_of(const TextureUse& use, const Vertices& vertices) const;
    void prepare(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    void prepare_for_suns(const GlObject& program, const Primitive& primitive) const;
    void prepare_emission(const GlObject& program, const Primitive& primitive) const;
    void prepare_lightmap(std::uint32_t array, std::size_t primitive) const;

    const Scene& scene_;
    std::vector<Vertices> vertices_;  ///< [vertex arrays]
    std::vector<GlObject> indices_;   ///< [primitives]
    std::vector<glm::vec3> centers_;  ///< [primitives] mean of one corner of each triangle
    std::vector<GlObject> textures_;  ///< [images]
    std::vector<bool> encoded_;       ///< [images] whether the image is sRGB-encoded
    std::vector<glm::vec3> emission_; ///< [materials]; empty: no emission
    GlLightmapTextures lightmaps_;
    std::size_t bytes_ = 0;
};

/// Creates an immutable texture without content. Throws `Error` if memory runs out.
GlObject make_texture_2d(int levels, std::uint32_t format, int width, int height);
/// Creates a lat-long texture for background.frag.
GlObject make_background(const Image& image);

} // namespace prt
