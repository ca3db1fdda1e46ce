#pragma once

// Cube maps unfolded to a cross or a row.

#include "prt/core/environment.h"

#include <optional>

namespace prt {

/// Returns the faces in a column as in `EnvironmentLayout::cube_faces`. Supported are a 4:3 cross (middle
/// row: -X +Z +X -Z; +Y above and -Y below +Z), a 3:4 cross (-Z rotated by 180 degrees below -Y), and a row
/// of +X -X +Y -Y +Z -Z. Returns no value for other shapes, and for cross-shaped images with more than one
/// color outside the faces, which are ordinary pictures.
std::optional<Image> faces_of_cross(const Image& image);

} // namespace prt
