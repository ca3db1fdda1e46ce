#pragma once

// Transformation of normals.

#include "runtime/load/triangle_normal.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace prt {

/// Returns the cofactors of the matrix, which transform normals: the transposed inverse times the
/// determinant. They also exist for singular matrices.
inline glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

/// Transforms normals by one matrix.
class NormalTransform {
public:
    explicit NormalTransform(const glm::dmat4& matrix)
        : cofactors_(cofactors(glm::dmat3(matrix))),
          side_(glm::determinant(glm::dmat3(matrix)) < 0 ? -1 : 1) {}

    glm::vec3 operator()(const glm::vec3& normal) const {
        return unit_or_zero(side_ * (cofactors_ * glm::dvec3(normal)));
    }

private:
    glm::dmat3 cofactors_;
    double side_;
};

inline glm::vec3 transformed_normal(const glm::vec3& normal, const glm::dmat4& matrix) {
    return NormalTransform(matrix)(normal);
}

/// Returns the normal that `transformed_normal` maps to `normal`.
inline glm::vec3 normal_before(const glm::vec3& normal, const glm::dmat4& matrix) {
    return unit_or_zero(glm::transpose(glm::dmat3(matrix)) * glm::dvec3(normal));
}

} // namespace prt
