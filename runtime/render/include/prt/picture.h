#pragma once

// Description of a picture, independent of the renderer. `render_gl` (prt/gl_renderer.h) and `render_rays`
// (prt/ray_renderer.h) render the same picture from it. Experimental.

#include "prt/camera.h"
#include "prt/clustered_transfer.h"
#include "prt/environment.h"
#include "prt/lightmap.h"
#include "prt/scene.h"
#include "prt/sun.h"
#include "prt/texture.h"
#include "prt/transfer_layout.h"

#include <span>
#include <vector>

namespace prt {

/// Environment behind the scene.
struct Background {
    const Image* image = nullptr; ///< lat-long; null: black
    float rotation = 0;           ///< about +Y, as in `rotated_about_y`; radians
};

/// Lightmaps that light surfaces instead of their vertices.
struct PictureLightmaps {
    const LightmapLayout* layout = nullptr; ///< null: no lightmaps
    std::span<const glm::vec3> radiance;    ///< [texels of the layout] exit radiance for albedo 1, or a color
    /// If set, the OpenGL renderer computes the radiance on the GPU from this transfer and `lighting`.
    const CompressedLightmap* on_gpu = nullptr;
    const Lighting* lighting = nullptr;
};

/// Transfer that a vertex shader multiplies with a lighting.
struct LitInShader {
    const ClusteredTransfer* transfer = nullptr;
    const Lighting* lighting = nullptr;
    PictureLightmaps lightmaps = {}; ///< used by all renderers
};

/// A picture of a lit scene.
struct Picture {
    const Scene* scene = nullptr;
    std::span<const Texture> textures; ///< load_textures(*scene)

    /// [receivers] exit radiance for albedo 1, or a color to show.
    std::span<const glm::vec3> radiance;
    /// If its transfer is set, the OpenGL renderer computes the exit radiance in the vertex shader and
    /// ignores `radiance`.
    LitInShader in_shader;
    /// Suns that are not included in `radiance`; the renderer adds their light at each pixel with sharp
    /// shadows.
    std::span<const Sun> suns = {};

    /// [materials] factor on the emission; empty: no emission.
    std::span<const glm::vec3> emission = {};

    bool textured = true; ///< multiply radiance by the base color; false if colors visualise a number
    Background background;

    Camera camera;
    int width = 1280, height = 720;
    int samples = 2; ///< per pixel along each axis
};

/// Returns the strength of each material's emission, [materials]: the strength of its lamp in `lamps`
/// [layout.lamps()], or 1 if `lamps` is empty or no lamp of the transfer contains the material.
std::vector<glm::vec3> emission_strengths(const Scene& scene, const TransferLayout& layout,
                                          std::span<const glm::vec3> lamps);

/// Returns the background in view direction `direction`.
glm::vec3 background_radiance(const Picture& picture, const glm::vec3& direction);

} // namespace prt
