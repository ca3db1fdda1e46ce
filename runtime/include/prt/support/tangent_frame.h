#pragma once

// Orthonormal frames about normals. Experimental.

#include <glm/vec3.hpp>

#include <cmath>

namespace prt {

/// Orthonormal frame at a surface point.
struct TangentFrame {
    glm::vec3 tangent, bitangent, normal;
};

/// Returns a right-handed orthonormal frame about unit `normal` (Duff et al. 2017, "Building an Orthonormal
/// Basis, Revisited").
inline TangentFrame tangent_frame(const glm::vec3& normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;
    return {{1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            {b, sign + normal.y * normal.y * a, -normal.y},
            normal};
}

} // namespace prt
