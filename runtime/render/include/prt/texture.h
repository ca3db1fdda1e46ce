#pragma once

// Textures of materials: a mip chain for OpenGL, and the same filtering on the CPU. Experimental.

#include "prt/image_file.h"
#include "prt/scene.h"
#include "prt/support/glm_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <vector>

namespace prt {

/// Encoding of red, green and blue: the sRGB curve for colors, linear for data. Alpha is always linear.
enum class TextureEncoding { srgb, linear };

/// Mip chain. Each level is the average of 2 x 2 decoded texels of the previous one. Level 0 is the image;
/// the last level is one texel.
struct Texture {
    std::vector<Image8> levels;
    TextureEncoding encoding = TextureEncoding::srgb;
};

Texture make_texture(Image8 image, TextureEncoding encoding = TextureEncoding::srgb);

/// Samples with trilinear filtering at texture coordinates `uv` (glTF: origin at the top left) and level of
/// detail `lod`, which is clamped to the available levels. Returns linear color and alpha.
glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod);

/// Treatment of missing or damaged textures.
enum class BadTextures {
    error,  ///< throw an `Error` with the name of the image
    ignore, ///< leave them empty: only the material's factors are used
};

/// Purpose of the textures.
enum class TextureNeeds {
    shadows,    ///< cut-outs, blended surfaces, glass and leaves: what rays pass through
    visibility, ///< the same and emission
    pictures,   ///< base color and emission
    all,        ///< textures for visibility, and for reflected light
};

/// Returns the images that the surfaces of `scene` need for a purpose, with their encoding. An image that
/// holds both colors and data counts as colors.
std::map<int, TextureEncoding> needed_images(const Scene& scene, TextureNeeds needs);

/// Returns whether `use` has an image that is not among the loaded `textures`. Returns false if `textures` is
/// empty.
bool is_missing(const TextureUse& use, std::span<const Texture> textures);

/// Loads the images of `needed_images` as textures, by image index; other entries stay empty.
std::vector<Texture> load_textures(const Scene& scene, BadTextures bad = BadTextures::error,
                                   TextureNeeds needs = TextureNeeds::all);

} // namespace prt
