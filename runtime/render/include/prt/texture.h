#pragma once

// Base-colour textures: a mip chain that OpenGL can take as it is, and the same filtering on the CPU.

#include "prt/glm_layout.h"
#include "prt/image_file.h"
#include "prt/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace prt {

/// sRGB-encoded colour and linear alpha; each level is the average of 2 x 2 texels of the one before, in
/// linear light. Level 0 is the image; the last is one texel.
struct Texture {
    std::vector<Image8> levels;
};

Texture make_texture(Image8 image);

/// Trilinear filtering at texture coordinates `uv` (glTF: origin at the top left) and level of detail `lod`,
/// which is clamped to the levels there are. Returns linear colour and alpha.
glm::vec4 sample(const Texture& texture, const TextureUse& use, const glm::vec2& uv, float lod);

/// What to do about textures that are missing or damaged.
enum class BadTextures {
    error,  ///< throw an `Error` that names the image
    ignore, ///< leave them empty: the material's factors alone count
};

/// The textures that the materials of `scene` use for colour, coverage and transmission, by image index;
/// others stay empty.
std::vector<Texture> load_textures(const Scene& scene, BadTextures bad = BadTextures::error);

} // namespace prt
