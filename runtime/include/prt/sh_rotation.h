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

/// What an element of R^T R, or the squared length of a quaternion, may be off: what thousands of products of
/// float matrices leave.
inline constexpr double kRotationTolerance = 2e-3;

/// Rotates SH vectors: for a function f with coefficients c, the result holds f'(w) = f(R^-1 w). Bands 1 and
/// 2 are a vector and a quadratic form, which R turns as it is. For the others R is taken apart into R_z R_y
/// R_z, and R_y into quarter turns about x and another R_z (docs/math.md, eq. 4): turns about z are products
/// with cosines and sines, the quarter turns are constant and three quarters of them zero. All arithmetic is
/// in double, so that ten thousand steps lose nothing to speak of. Small, allocates nothing, thread-safe;
/// serves every order up to the one it was made for.
class ShRotation {
public:
    /// Throws `Error` for an order outside 1..kMaxOrder and for matrices that are not rotations within
    /// `kRotationTolerance`: scaled, sheared, mirrored ones, and NaN. What is left of such an error is taken
    /// out.
    ShRotation(int order, const glm::dmat3& rotation);
    /// Throws `Error` unless the squared length of `rotation` is 1 within `kRotationTolerance`.
    ShRotation(int order, const glm::dquat& rotation);
    /// Turns by `angle` radians, counter-clockwise seen from the tip of the axis.
    static ShRotation about_x(int order, double angle);
    static ShRotation about_y(int order, double angle);
    static ShRotation about_z(int order, double angle); ///< the cheapest

    int order() const { return order_; }
    /// `in` and `out` are [order²] and may be the same.
    void apply(std::span<const float> in, std::span<float> out) const;
    void apply(std::span<const double> in, std::span<double> out) const;
    /// RGB coefficients [order²] in place: three functions at little more than the price of one.
    void apply(std::span<glm::vec3> coefficients) const;
    /// The same from `in` to `out`, which may be the same.
    void apply(std::span<const glm::vec3> in, std::span<glm::vec3> out) const;

    /// cos(m a) and sin(m a) of a turn about z.
    struct Turn {
        static constexpr std::size_t kZero = 3; ///< where m = 0 stands; bands side by side reach before it
        std::array<double, kZero + kMaxOrder> cosine, sine;
        Turn() {} // left as it is where the order has no need of it
    };
    /// z first, then tilt about y, then z again.
    struct Turns {
        Turn first, tilt, last;
        bool tilted = false; ///< else `first` is all there is
    };

private:
    int order_;
    glm::dmat3 matrix_; ///< bands 1 and 2 come from its elements
    Turns turns_;       ///< the others
};

} // namespace prt
