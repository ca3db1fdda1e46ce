#pragma once

// Rotation of spherical harmonics. Stable.

#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>

namespace prt {

/// Maximum error of an element of R^T R, or of the squared length of a quaternion. It allows for the rounding
/// of thousands of products of float matrices.
inline constexpr double kRotationTolerance = 2e-3;

/// Rotates SH vectors: for a function f with coefficients c, the result has f'(w) = f(R^-1 w). Bands 1 and 2
/// are a vector and a quadratic form, which R rotates directly. For higher bands R is decomposed into R_z R_y
/// R_z, and R_y into rotations by 90 degrees about x and another R_z (docs/math.md, eq. 4). Rotations about z
/// are products with cosines and sines; the rotations by 90 degrees are constant matrices, and three quarters
/// of their elements are zero. All arithmetic is in double, so that ten thousand steps lose no visible
/// precision. Small, allocates nothing, thread-safe; serves every order up to that of the constructor.
class ShRotation {
public:
    /// Throws `Error` for an order outside 1..kMaxOrder and for matrices that are not rotations within
    /// `kRotationTolerance`: scaled, sheared, mirrored, or with NaN. Smaller errors are removed by
    /// orthonormalisation.
    ShRotation(int order, const glm::dmat3& rotation);
    /// Throws `Error` unless the squared length of `rotation` is 1 within `kRotationTolerance`.
    ShRotation(int order, const glm::dquat& rotation);
    /// Returns a rotation by `angle` radians, counter-clockwise seen from the tip of the axis.
    static ShRotation about_x(int order, double angle);
    static ShRotation about_y(int order, double angle);
    static ShRotation about_z(int order, double angle); ///< the fastest

    int order() const { return order_; }
    /// Rotates [order²] coefficients; `in` and `out` may be the same.
    void apply(std::span<const float> in, std::span<float> out) const;
    void apply(std::span<const double> in, std::span<double> out) const;
    /// Rotates RGB coefficients [order²] in place. Three channels together cost little more than one.
    void apply(std::span<glm::vec3> coefficients) const;
    /// Rotates RGB coefficients [order²]; `in` and `out` may be the same.
    void apply(std::span<const glm::vec3> in, std::span<glm::vec3> out) const;

    /// cos(m a) and sin(m a) of a rotation by a about z.
    struct Rotation {
        static constexpr std::size_t kZero = 3; ///< index of m = 0; vector code that handles several bands
                                                ///< reads the entries before it
        std::array<double, kZero + kMaxOrder> cosine, sine;
        Rotation() {} // leaves entries that the order does not use uninitialised
    };
    /// Decomposition of a rotation: about z first, then about y (tilt), then about z again.
    struct Rotations {
        Rotation first, tilt, last;
        bool tilted = false; ///< false: the rotation is `first` alone
    };

private:
    int order_;
    glm::dmat3 matrix_;   ///< rotates bands 1 and 2
    Rotations rotations_; ///< rotates the higher bands
};

} // namespace prt
