#pragma once

// Tiling pictures of the courtyard's building materials. Sizes are those of one picture on the wall.

#include "picture.h"

namespace examples {

inline constexpr float kPlasterMetres = 3, kPavingMetres = 2.4f, kGlazedMetres = 0.8f, kStoneMetres = 1,
                       kPlankMetres = 0.8f;

/// Lime wash with clouds and a few stains.
SharedPicture plaster_picture();
/// Slabs of stone in courses of uneven widths, with joints.
SharedPicture paving_picture();
/// Azulejos: four by four glazed tiles with an eight-pointed star.
SharedPicture glazed_tile_picture();
SharedPicture stone_picture();
/// Four boards, upright.
SharedPicture plank_picture();
/// Awning cloth, one stripe of each color.
SharedPicture striped_picture(const std::string& name, const glm::vec3& one, const glm::vec3& other);
/// Eight by eight roof tiles, fired unevenly; a tile is one unit of both texture coordinates times eight.
SharedPicture roof_tile_picture();
SharedPicture bark_picture();
/// A leaf from its stem (below) to its tip, with a light vein.
SharedPicture leaf_picture();

} // namespace examples
