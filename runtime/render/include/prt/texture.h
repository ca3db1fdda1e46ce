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

/// A texture with its mip chain. Each texel of a level is the average of 2 x 2 decoded texels of the previous
/// one. Level 0 is the image; the last level is one texel.
struct Texture {
    std::vector<Image8> levels;
    TextureEncoding encoding = TextureEncoding::srgb;
};

/// Builds the mip chain of `image`.
Texture make_texture(Image8 image, TextureEncoding encoding = TextureEncoding::srgb);

/// Returns linear color and alpha at texture coordinates `uv` (glTF: origin at the top left), filtered
/// trilinearly at level of detail `lod`, which is clamped to the available levels.
glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod);

/// Treatment of missing or damaged textures.
enum class BadTextures {
    error,  ///< throw an `Error` with the name of the image
    ignore, ///< leave the texture empty: only the material's factors are used
};

/// Purpose of the textures.
enum class TextureNeeds {
    shadows,    ///< textures that determine where rays pass: of cut-outs, blended surfaces, glass and leaves
    visibility, ///< textures of `shadows`, and of emission
    pictures,   ///< textures of base color and emission
    all,        ///< textures of `visibility`, and those of reflected light
};

/// Returns the images that the surfaces of `scene` need for a purpose, with their encoding. An image with
/// both colors and data counts as colors.
std::map<int, TextureEncoding> needed_images(const Scene& scene, TextureNeeds needs);

/// Returns whether `use` has an image whose texture was not loaded into `textures`; false if `textures` is
/// empty.
bool is_missing(const TextureUse& use, std::span<const Texture> textures);

/// Loads the images of `needed_images` as textures, [images of the scene]; other entries stay empty. Throws
/// `Error` if they exceed the memory limit, or as `bad` specifies.
std::vector<Texture> load_textures(const Scene& scene, BadTextures bad = BadTextures::error,
                                   TextureNeeds needs = TextureNeeds::all);

} // namespace prt
