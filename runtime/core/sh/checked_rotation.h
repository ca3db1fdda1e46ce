#pragma once

// Validation of rotation matrices.

#include <glm/mat3x3.hpp>

namespace prt {

/// Throws `Error` unless `r` is a rotation within kRotationTolerance. Sets `result`, a copy of `r`, to the
/// nearest rotation.
void make_rotation(const glm::dmat3& r, glm::dmat3& result);

} // namespace prt
