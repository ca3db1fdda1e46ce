#pragma once

// Textures of materials: builds mip chains for OpenGL, and filters them on the CPU like OpenGL. Experimental.

#include "prt/core/glm_layout.h"
#include "prt/image/image_file.h"
#include "prt/load/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <vector>

namespace prt {

/// Encoding of the red, green and blue bytes of a texture. Alpha is always linear.
enum class TextureEncoding {
    srgb,  ///< sRGB curve, for colors
    linear ///< value / 255, for data
};

/// A texture with its mip chain.
struct Texture {
    /// Level 0 is the image; the last level is one texel. Each texel of a level is the average of 2 x 2
    /// decoded texels of the previous level. Empty: the texture is not loaded.
    std::vector<Image8> levels;
    TextureEncoding encoding = TextureEncoding::srgb; ///< encoding of all levels
};

/// Builds the mip chain of `image`, which must have at least one pixel. `encoding`: encoding of the bytes of
/// `image`.
Texture make_texture(Image8 image, TextureEncoding encoding = TextureEncoding::srgb);

/// Returns the linear color and alpha of `texture` at `uv`, each 0..1, filtered trilinearly. `use`: only its
/// wrap modes are used; apply use.transform to `uv` before. `uv`: texture coordinates of glTF, origin at the
/// top left of the image. `lod`: level of detail; 0 is the finest level; clamped to the existing levels.
/// `texture` must be loaded. Returns black with alpha 1 if `uv` is not finite, or is 1e9 texels or more from
/// the origin.
glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod);

/// Treatment of missing, damaged or unsupported images in `load_textures`.
enum class BadTextures {
    error,  ///< throw an `Error` with the name of the image
    ignore, ///< leave the texture empty: renderers use only the factor that it multiplies, and show no
            ///< emission if it is a texture of emission
};

/// Purpose for which textures are needed. A texture is never needed if no primitive uses its material.
enum class TextureNeeds {
    shadows,    ///< light through surfaces: base color of cut-outs, blended surfaces and surfaces with
                ///< diffuse transmission; textures of diffuse transmission and of glass
    visibility, ///< textures of `shadows`, and of emission
    pictures,   ///< base color and emission of all surfaces, nothing else
    all,        ///< textures of `visibility`, base color of all surfaces, and texture of the metallic
                ///< factor
};

/// Returns the images that the surfaces of `scene` need for purpose `needs`: index into Scene::images, and
/// encoding of the image. An image that is used both as color and as data gets TextureEncoding::srgb.
std::map<int, TextureEncoding> needed_images(const Scene& scene, TextureNeeds needs);

/// Returns whether `use` refers to an image whose element of `textures` is empty. `textures`: result of
/// load_textures, [images]. Returns false if `use` has no image, or if `textures` has no elements.
bool is_missing(const TextureUse& use, std::span<const Texture> textures);

/// Decodes the images that `scene` needs for purpose `needs`, and builds their mip chains. Returns one
/// texture per element of Scene::images; textures that are not needed have no levels. `bad`: whether a
/// missing, damaged or unsupported image throws `Error`, or its texture stays without levels. Always throws
/// `Error` if the decoded images need more memory than 192 MB plus 64 times the size of their files.
std::vector<Texture> load_textures(const Scene& scene, BadTextures bad = BadTextures::error,
                                   TextureNeeds needs = TextureNeeds::all);

} // namespace prt
