#pragma once

// Scenes on the GPU: geometry, textures and materials for drawing. An OpenGL 4.5 context must be current for
// all functions.

#include "prt/render/picture.h"
#include "runtime/render/gl/gl_objects.h"
#include "runtime/render/gl/gl_relit_textures.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Vertex array objects of OpenGL, [Scene::vertex_arrays].
using GlVertexArrays = std::vector<GlObject>;

/// Range of triangles of a primitive, indices into Primitive::triangles.
struct TriangleRange {
    std::uint32_t first, count; ///< index of the first triangle, and number of triangles; `count` may be 0
};

/// Part of the incident light that a surface blocks.
enum class Blocking {
    nothing, ///< the material casts no shadow
    all,     ///< all light, except in cut-outs of AlphaMode::mask
    term     ///< some of the light: the surface is blended or glass
};

/// Geometry, textures and materials of a scene on the GPU. For programs whose fragment shader includes
/// `shaders/surface.glsl`. The fragment shader can also include `shaders/sun_light.glsl` for suns,
/// `shaders/emission.glsl` for emission, and `shaders/lightmap.glsl` for lightmaps. The functions that draw
/// change the bound vertex array, textures and storage buffers, and whether OpenGL culls faces.
class GlScene {
public:
    /// Uploads the scene and its textures. Keeps a reference to `scene`, but not to `textures`. `textures`:
    /// result of load_textures, [images of the scene]; empty: materials are drawn without textures. Throws
    /// `Error` if GPU memory runs out, or if the device does not support the size of a texture.
    GlScene(const Scene& scene, std::span<const Texture> textures);

    /// Returns the scene that was passed to the constructor.
    const Scene& scene() const { return scene_; }
    /// Creates vertex arrays, [Scene::vertex_arrays], with positions, normals and (if there are any) vertex
    /// colors as attributes PRT_LOCATION_POSITION, _NORMAL and _COLOR of shaders/shared_layout.h. This object
    /// must exist while they are drawn.
    GlVertexArrays make_vertex_arrays() const;
    /// Makes `buffer` the source of vertex attribute `location` in all `arrays`. `arrays`: result of
    /// make_vertex_arrays. `buffer`: floats, [receivers of the scene][components]; it must exist while
    /// `arrays` are drawn. `components`: 1 to 4.
    void attach_receivers(const GlVertexArrays& arrays, const GlObject& buffer, std::uint32_t location,
                          int components) const;

    /// Sets the factor on Emission::radiance of each material for subsequent draws. `strengths`:
    /// [materials], copied; empty (the default): surfaces emit no light.
    void shine(std::span<const glm::vec3> strengths) { emission_.assign(strengths.begin(), strengths.end()); }

    /// Sets the lightmaps for subsequent draws with programs that are built with `#define PRT_LIGHTMAP`.
    /// Keeps the view `lightmaps`; its textures and layout must exist while the scene is drawn. Default: no
    /// lightmaps.
    void light_by(const GlLightmapTextures& lightmaps) { lightmaps_ = lightmaps; }

    /// Returns whether the material of `primitive` has AlphaMode::blend. The caller must draw blended
    /// primitives after all others, from far to near, without writing depth.
    bool is_blended(const Primitive& primitive) const;
    /// Draws all triangles of a primitive. `program` must be in use; this function sets its uniforms for the
    /// material. `arrays`: result of make_vertex_arrays. `primitive`: index into Scene::primitives. Culls
    /// back faces unless the material is double-sided.
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    /// Draws only the triangles in `ranges` of a primitive; draws nothing if `ranges` is empty. `program`
    /// must be in use; this function sets its uniforms for the material. `arrays`: result of
    /// make_vertex_arrays. `primitive`: index into Scene::primitives. Culls back faces unless the material is
    /// double-sided.
    void draw(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
              std::span<const TriangleRange> ranges) const;
    /// Draws `count` instances of a primitive. `program` must be in use; this function sets its uniforms for
    /// the material. `arrays`: result of make_vertex_arrays, to which the caller has added the attributes per
    /// instance that `program` reads. `primitive`: index into Scene::primitives. Culls back faces unless the
    /// material is double-sided.
    void draw_instances(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive,
                        std::size_t count) const;
    /// Returns whether `primitive`, an element of Scene::primitives, blocks no light of a sun, all light or a
    /// part of it.
    Blocking blocking(const Primitive& primitive) const;
    /// Draws both sides of a primitive into the bound framebuffer, a shadow map; of a surface that the
    /// primitive contains once for each side, and that blocks a part of the light, only one. `program` must
    /// be in use and built from sun_caster.vert and sun_caster.frag; SunShadows::set_map must have set its
    /// uniforms. `arrays`: result of make_vertex_arrays. `primitive`: index into Scene::primitives. Leaves
    /// face culling disabled.
    void draw_caster(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    /// Returns the blended primitives as indices into Scene::primitives, from far to near. The distance of a
    /// primitive is that from `position` (metres, relative to Scene::origin) to the mean of the
    /// first corners of its triangles.
    std::vector<std::size_t> blended_from_far(const glm::vec3& position) const;
    /// Returns the size of positions, normals, texture coordinates and indices on the GPU in bytes. Textures
    /// and vertex colors are not included.
    std::size_t bytes() const { return bytes_; }

private:
    struct Vertices {
        GlObject positions, normals, colors;
        std::vector<GlObject> texcoords; ///< [set]; empty if the file has no such set
    };
    /// Returns the texture of `use`. Returns null if `use` has no image, if the image is not loaded, or if
    /// `vertices` have no coordinates for it.
    const GlObject* texture_of(const TextureUse& use, const Vertices& vertices) const;
    void prepare(const GlObject& program, const GlVertexArrays& arrays, std::size_t primitive) const;
    void prepare_for_suns(const GlObject& program, const Primitive& primitive) const;
    void prepare_emission(const GlObject& program, const Primitive& primitive) const;
    void prepare_lightmap(std::uint32_t array, std::size_t primitive) const;

    const Scene& scene_;
    std::vector<Vertices> vertices_;  ///< [vertex arrays]
    std::vector<GlObject> indices_;   ///< [primitives]
    std::vector<glm::vec3> centers_;  ///< [primitives] mean of one corner of each triangle
    std::vector<bool> twice_;         ///< [primitives] blocks a part of light with two opposite triangles
    std::vector<GlObject> textures_;  ///< [images]
    std::vector<bool> encoded_;       ///< [images] whether the image is sRGB-encoded
    std::vector<glm::vec3> emission_; ///< [materials]; empty: no emission
    GlLightmapTextures lightmaps_;
    std::size_t bytes_ = 0;
};

/// Creates a 2D texture of fixed size with undefined contents. `levels`: number of mip levels, 1 or more.
/// `format`: sized internal format of OpenGL, for example GL_RGBA8. `width` and `height`: texels of level 0.
/// Throws `GpuOutOfMemory` if GPU memory runs out, and `Error` if the device does not support the size or
/// OpenGL reports another error.
GlObject make_texture_2d(int levels, std::uint32_t format, int width, int height);
/// Creates a texture with one level from a lat-long image whose center is the direction +Z, for
/// background.frag. Throws the errors of `make_texture_2d`.
GlObject make_background(const Image& image);

} // namespace prt
