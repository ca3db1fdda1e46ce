#pragma once

// Small scenes that GPU bakes are held against CPU bakes on.

#include "prt/scene.h"
#include "prt/texture.h"

#include <vector>

namespace prt::test {

Scene balls_over_floor();
/// A ceiling over a floor that is blended, cut out by a texture, or a leaf.
Scene under_a_ceiling(AlphaMode mode);
/// Of that ceiling: one texture.
Texture dotted_texture();
/// The ceiling of glass with a texture, cut out, blended or neither.
Scene under_glass(AlphaMode mode);
/// Of that ceiling: two textures.
std::vector<Texture> glass_textures();

} // namespace prt::test
