#pragma once

#include <glm/mat3x3.hpp>

namespace prt {

/// Checks that `r` is a rotation within kRotationTolerance, or throws `Error`, and makes `result`, a copy of
/// it, the rotation next to it.
void make_rotation(const glm::dmat3& r, glm::dmat3& result);

} // namespace prt
