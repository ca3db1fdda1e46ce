#pragma once

// What a renderer draws, whichever renderer it is. `render_gl` (prt/gl_renderer.h) and `render_rays`
// (prt/ray_renderer.h) make the same picture of it. Experimental.

#include "prt/camera.h"
#include "prt/clustered_transfer.h"
#include "prt/environment.h"
#include "prt/lightmap.h"
#include "prt/scene.h"
#include "prt/sun_disc.h"
#include "prt/texture.h"
#include "prt/transfer_layout.h"

#include <span>
#include <vector>

namespace prt {

/// What is behind the scene.
struct Background {
    const Image* image = nullptr; ///< lat-long; null: black
    float rotation = 0;           ///< about +Y, as in `rotated_about_y`; radians
};

/// Lightmaps that light surfaces in the place of their vertices.
struct PictureLightmaps {
    const LightmapLayout* layout = nullptr; ///< null: there are none
    std::span<const glm::vec3> radiance;    ///< [texels of the layout] exit radiance for albedo 1, or a color
    /// Where set, OpenGL forms it on the GPU, lit by `lighting`.
    const CompressedLightmap* on_gpu = nullptr;
    const Lighting* lighting = nullptr;
};

/// Transfer, and the lighting that a vertex shader multiplies it with.
struct LitInShader {
    const ClusteredTransfer* transfer = nullptr;
    const Lighting* lighting = nullptr;
    PictureLightmaps lightmaps = {}; ///< whichever renderer
};

struct Picture {
    const Scene* scene = nullptr;
    std::span<const Texture> textures; ///< load_textures(*scene)

    /// Per receiver: exit radiance for albedo 1, or a color to show.
    std::span<const glm::vec3> radiance;
    /// Where set, OpenGL forms the exit radiance in the vertex shader from it instead of `radiance`.
    LitInShader in_shader;
    /// Their light is not in the radiance above but is added at each pixel, sharply shadowed.
    std::span<const SunDisc> suns = {};

    /// What the emission of each material is multiplied with, [materials]; empty: nothing shines.
    std::span<const glm::vec3> emission = {};

    bool textured = true; ///< multiply by base color; off for views that show a number
    Background background;

    Camera camera;
    int width = 1280, height = 720;
    int samples = 2; ///< per pixel along each axis
};

/// The strength of each material's emission, [materials]: that of the lamp that it is a member of, of `lamps`
/// [layout.lamps()] or 1 where those are empty; 1 where the transfer knows nothing of it.
std::vector<glm::vec3> emission_strengths(const Scene& scene, const TransferLayout& layout,
                                          std::span<const glm::vec3> lamps);

/// `background` sampled for the view direction `direction`.
glm::vec3 background_radiance(const Picture& picture, const glm::vec3& direction);

} // namespace prt
