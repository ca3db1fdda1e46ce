#pragma once

// Orthonormal frames whose third axis is a given normal. Experimental.

#include <glm/vec3.hpp>

#include <cmath>

namespace prt {

/// Orthonormal, right-handed frame at a surface point: three orthogonal unit vectors with normal =
/// cross(tangent, bitangent). The directions of tangent and bitangent do not depend on texture coordinates.
struct TangentFrame {
    glm::vec3 tangent, bitangent, normal;
};

/// Returns a right-handed orthonormal frame with the given unit `normal` (Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited"). The rotation of tangent and bitangent about the normal is arbitrary, but
/// the same for the same normal; it jumps where normal.z changes its sign.
inline TangentFrame tangent_frame(const glm::vec3& normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;
    return {{1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            {b, sign + normal.y * normal.y * a, -normal.y},
            normal};
}

} // namespace prt
