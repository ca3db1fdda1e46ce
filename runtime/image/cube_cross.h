#pragma once

// Cube maps unfolded to a cross, or in a row.

#include "prt/environment.h"

#include <optional>

namespace prt {

/// The faces of a cross of 4:3 (row in the middle: -X +Z +X -Z; +Y above and -Y below +Z), a cross of 3:4 (-Z
/// turned by half a turn below -Y), or a row of +X -X +Y -Y +Z -Z, in a column as
/// `EnvironmentLayout::cube_faces`. Nothing for images of other shapes, and for those of a cross's shape with
/// more than one color outside it: pictures.
std::optional<Image> faces_of_cross(const Image& image);

} // namespace prt
