#pragma once

// Textures of materials: a mip chain that OpenGL can take as it is, and the same filtering on the CPU.
// Experimental.

#include "prt/image_file.h"
#include "prt/scene.h"
#include "prt/support/glm_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <vector>

namespace prt {

/// How red, green and blue are stored: colors by the sRGB curve, numbers as they are. Alpha is a number.
enum class TextureEncoding { srgb, linear };

/// Each level is the average of 2 x 2 texels of the one before, decoded. Level 0 is the image; the last is
/// one texel.
struct Texture {
    std::vector<Image8> levels;
    TextureEncoding encoding = TextureEncoding::srgb;
};

Texture make_texture(Image8 image, TextureEncoding encoding = TextureEncoding::srgb);

/// Trilinear filtering at texture coordinates `uv` (glTF: origin at the top left) and level of detail `lod`,
/// which is clamped to the levels there are. Returns linear color and alpha.
glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod);

/// What to do about textures that are missing or damaged.
enum class BadTextures {
    error,  ///< throw an `Error` that names the image
    ignore, ///< leave them empty: the material's factors alone count
};

/// Purposes that textures are needed for.
enum class TextureNeeds {
    shadows,    ///< what rays pass through: cut-outs, blended surfaces, glass, leaves
    visibility, ///< that, and emission
    pictures,   ///< base color and emission
    all,        ///< those of visibility, and what light bounces off
};

/// The images that the surfaces of `scene` use for that, with how they are encoded. One that holds both
/// colors and numbers counts as colors.
std::map<int, TextureEncoding> needed_images(const Scene& scene, TextureNeeds needs);

/// Whether `use` has an image that is not among the loaded `textures`. Where none are given, none is asked
/// for.
bool is_missing(const TextureUse& use, std::span<const Texture> textures);

/// Those images as textures, by image index; others stay empty.
std::vector<Texture> load_textures(const Scene& scene, BadTextures bad = BadTextures::error,
                                   TextureNeeds needs = TextureNeeds::all);

} // namespace prt
