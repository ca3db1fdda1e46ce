#pragma once

// Derivatives of the first four bands of the SH basis (docs/math.md, eq. 3, as polynomials).

#include <glm/vec3.hpp>

#include <array>

namespace prt {

/// Returns the gradient of basis function l(l+1)+m with respect to x, y and z. It is correct only along the
/// sphere, which is sufficient because the vector stays unit.
inline std::array<glm::dvec3, 16> sh_gradients(const glm::dvec3& d) {
    constexpr double k1 = 0.48860251190291992, k2 = 1.0925484305920792, k20 = 0.31539156525252005,
                     k22 = 0.54627421529603959, k33 = 0.59004358992664352, k32 = 2.8906114426405538,
                     k31 = 0.45704579946446572, k30 = 0.3731763325901154, k3z = 1.4453057213202769;
    const double x = d.x, y = d.y, z = d.z;
    return {glm::dvec3(0),
            k1 * glm::dvec3(0, -1, 0),
            k1 * glm::dvec3(0, 0, 1),
            k1 * glm::dvec3(-1, 0, 0),
            k2 * glm::dvec3(y, x, 0),
            k2 * glm::dvec3(0, -z, -y),
            k20 * glm::dvec3(0, 0, 6 * z),
            k2 * glm::dvec3(-z, 0, -x),
            k22 * glm::dvec3(2 * x, -2 * y, 0),
            k33 * glm::dvec3(-6 * x * y, 3 * (y * y - x * x), 0),
            k32 * glm::dvec3(y * z, x * z, x * y),
            k31 * glm::dvec3(0, 1 - 5 * z * z, -10 * y * z),
            k30 * glm::dvec3(0, 0, 15 * z * z - 3),
            k31 * glm::dvec3(1 - 5 * z * z, 0, -10 * x * z),
            k3z * glm::dvec3(2 * x * z, -2 * y * z, x * x - y * y),
            k33 * glm::dvec3(3 * (y * y - x * x), 6 * x * y, 0)};
}

} // namespace prt
