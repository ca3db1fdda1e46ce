// Rejects matrices that are not rotations, and orthonormalises the others.
#include "runtime/core/sh/checked_rotation.h"

#include "prt/core/error.h"
#include "prt/core/sh_rotation.h"
#include "runtime/core/support/vector_lanes.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {
namespace {

[[gnu::always_inline]] inline double product(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Elements of R^T R - 1.
struct Deviation {
    double xx, yy, zz, xy, yz, xz;

    explicit Deviation(const glm::dmat3& r)
        : xx(product(r[0], r[0]) - 1), yy(product(r[1], r[1]) - 1), zz(product(r[2], r[2]) - 1),
          xy(product(r[0], r[1])), yz(product(r[1], r[2])), xz(product(r[0], r[2])) {}

    bool within(double allowed) const {
        return std::ranges::all_of(std::array{xx, yy, zz, xy, yz, xz},
                                   [&](double off) { return std::abs(off) <= allowed; }); // false for NaN
    }
};

/// Returns a step of Newton's iteration for the polar decomposition, R (3 - R^T R) / 2, which squares the
/// error.
glm::dmat3 nearer_rotation(const glm::dmat3& r, const Deviation& d) {
    const glm::dvec3 &x = r[0], &y = r[1], &z = r[2];
    return {x - 0.5 * (d.xx * x + d.xy * y + d.xz * z), y - 0.5 * (d.xy * x + d.yy * y + d.yz * z),
            z - 0.5 * (d.xz * x + d.yz * y + d.zz * z)};
}

/// Maximum squared error of a rotation matrix by rounding, in doubles and in floats.
constexpr double kDoubleRounding = 1e-28, kFloatRounding = 1e-13;

/// Makes `result`, a copy of `r`, orthonormal if the error of `r` does not exceed the rounding of floats;
/// otherwise returns false. The third column of a rotation is the cross product of the first two, which are
/// orthonormal.
PRT_TWO_CLONES
bool made_rotation(const glm::dmat3& r, glm::dmat3& result) {
    const glm::dvec3 &x = r[0], &y = r[1];
    const double xx = product(x, x) - 1, yy = product(y, y) - 1, xy = product(x, y);
    const glm::dvec3 off = r[2] - cross(x, y);
    const double squares = (xx * xx + yy * yy) + (xy * xy + product(off, off));
    if (!(squares < kFloatRounding)) // true for NaN
        return false;
    if (squares >= kDoubleRounding) {
        result[0] = x - 0.5 * (xx * x + xy * y);
        result[1] = y - 0.5 * (xy * x + yy * y);
        result[2] = cross(result[0], result[1]);
    }
    return true;
}

} // namespace

void make_rotation(const glm::dmat3& r, glm::dmat3& result) {
    if (made_rotation(r, result))
        return;
    if (!Deviation(r).within(kRotationTolerance))
        throw Error("the matrix is not a rotation: it scales, shears or is not finite");
    if (glm::dot(glm::cross(r[0], r[1]), r[2]) < 0)
        throw Error(
            "the matrix is not a rotation: it mirrors; remove the mirroring and bake the mirrored mesh");
    do {
        const glm::dmat3 before = result;
        result = nearer_rotation(before, Deviation(before));
    } while (!made_rotation(glm::dmat3(result), result));
}

} // namespace prt
