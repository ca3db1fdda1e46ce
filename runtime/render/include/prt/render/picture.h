#pragma once

// Description of a picture, independent of the renderer. `render_gl` (prt/gl/gl_renderer.h) and `render_rays`
// (bake/reference/ray_renderer.h) render the same picture from it. Experimental.

#include "prt/core/clustered_transfer.h"
#include "prt/core/environment.h"
#include "prt/core/light.h"
#include "prt/core/lightmap.h"
#include "prt/core/transfer_layout.h"
#include "prt/load/scene.h"
#include "prt/render/camera.h"
#include "prt/render/texture.h"

#include <span>
#include <vector>

namespace prt {

/// Environment that is visible behind the scene; it does not light the scene.
struct Background {
    const Image* image = nullptr; ///< lat-long radiance, center +Z; not owned; null: black
    float rotation = 0;           ///< radians about +Y; pi/2 moves the radiance of +Z to +X
};

/// Lightmaps that provide the light of surfaces, instead of values at vertices. Owns nothing.
struct PictureLightmaps {
    const LightmapLayout* layout = nullptr; ///< null: no lightmaps
    std::span<const glm::vec3> radiance;    ///< [layout->texels()] exit radiance for albedo 1, or a color
    /// If not null, the OpenGL renderer computes the radiance on the GPU from this lightmap and `lighting`,
    /// and ignores `radiance`. Other renderers ignore this member and use `radiance`.
    const CompressedLightmap* on_gpu = nullptr;
    const Lighting* lighting = nullptr; ///< used only with `on_gpu`; must then not be null
};

/// Light that a renderer computes from transfer or reads from lightmaps. Owns nothing. Surfaces with lobes
/// (VertexArray::lobes) have neither, and show `Picture::radiance`.
struct LitInShader {
    /// If not null, and without lightmaps, the OpenGL renderer computes exit radiance in the vertex shader
    /// from this transfer and `lighting`. Other renderers ignore this member.
    const ClusteredTransfer* transfer = nullptr;
    const Lighting* lighting = nullptr; ///< used only with `transfer`; must then not be null
    /// All renderers use these lightmaps, if `lightmaps.layout` is not null, instead of light at vertices.
    PictureLightmaps lightmaps = {};
};

/// A picture of a lit scene: input of a renderer. Owns nothing that it points to.
struct Picture {
    const Scene* scene = nullptr;      ///< must not be null
    std::span<const Texture> textures; ///< result of load_textures(*scene); empty: no textures

    /// [receivers of the scene] exit radiance for albedo 1 in linear Rec. 709, or a color to show. All
    /// renderers ignore this member if `in_shader.lightmaps` is set. The OpenGL renderer ignores this member
    /// if `in_shader.transfer` is set. Surfaces with lobes always use it.
    std::span<const glm::vec3> radiance;
    /// Transfer or lightmaps that replace `radiance`; by default not set.
    LitInShader in_shader;
    /// Suns whose direct light is not included in `radiance`. The renderer adds this light at each pixel,
    /// with shadows, except on surfaces with a medium (`lit_through_medium`): all of their sun light is
    /// indirect. Empty: no suns. The OpenGL renderer supports at most kMaxShadowedSuns suns.
    std::span<const Sun> suns = {};

    /// [materials] factor on Emission::radiance; empty: surfaces emit no light.
    std::span<const glm::vec3> emission = {};

    /// Whether renderers multiply the radiance by the base color, blend surfaces of AlphaMode::blend, and cut
    /// holes into surfaces of AlphaMode::mask. False serves to show colors that visualise a number: all
    /// surfaces are then opaque.
    bool textured = true;
    Background background;

    Camera camera;
    int width = 1280, height = 720; ///< pixels
    int samples = 2;                ///< samples per pixel along each axis: samples² in total
};

/// Returns the factor on the emission of each material, [materials of the scene], for Picture::emission. The
/// factor of a material is the strength of the lamp in `layout` that contains the material. It is 1 if no
/// lamp contains the material, or if `lamps` is empty. `lamps`: strength or color of each lamp,
/// [layout.lamps()] or empty.
std::vector<glm::vec3> emission_strengths(const Scene& scene, const TransferLayout& layout,
                                          std::span<const glm::vec3> lamps);

/// Returns the radiance of picture.background in unit direction `direction` (away from the camera),
/// bilinearly filtered; 0 if there is no image.
glm::vec3 background_radiance(const Picture& picture, const glm::vec3& direction);

} // namespace prt
