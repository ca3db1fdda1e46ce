#pragma once

// Small scenes that GPU bakes are held against CPU bakes on.

#include "prt/load/scene.h"
#include "prt/render/texture.h"

#include <cstdint>
#include <vector>

namespace prt::test {

Scene balls_over_floor();
/// A ceiling over a floor that is blended, cut out by a texture, or a leaf.
Scene under_a_ceiling(AlphaMode mode);
/// Returns the texture of that ceiling.
Texture dotted_texture();
/// The ceiling of glass with a texture, cut out, blended or neither.
Scene under_glass(AlphaMode mode);
/// Returns the two textures of the glass ceiling.
std::vector<Texture> glass_textures();
/// Returns copies of a ball and of a dotted leaf over a floor, rotated, scaled and moved; one of the balls is
/// squeezed. `alone`: each copy has a separate mesh, as if the file stored it so.
Scene copies_over_floor(int copies, bool alone);
/// Scattered triangles, among them points, lines, needles, doubles and far ones, over a floor.
Scene degenerate_triangles(std::uint32_t seed);

} // namespace prt::test
