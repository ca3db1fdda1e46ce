#pragma once

// Rotation of functions that are given by SH coefficients, such as lighting. Stable.

#include "prt/core/glm_layout.h"
#include "prt/core/sh_basis.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>

namespace prt {

/// Maximum deviation from a rotation that the constructors of `ShRotation` accept: of each element of R^T R
/// from the unit matrix, and of the squared length of a quaternion from 1. It allows for the rounding of
/// thousands of products of float matrices.
inline constexpr double kRotationTolerance = 2e-3;

/// A rotation R of functions on the sphere. It maps the SH coefficients of a function f to those of f'(w) =
/// f(R^-1 w): light from direction w then comes from R w (docs/math.md, eq. 4). All arithmetic is in double,
/// so that ten thousand successive rotations lose no visible precision. Immutable and thread-safe; allocates
/// no memory unless a constructor throws.
class ShRotation {
public:
    /// Creates the rotation R = `rotation`, which multiplies column vectors, for SH vectors of `order` bands.
    /// A matrix that deviates from a rotation by at most `kRotationTolerance` is orthonormalised. Throws
    /// `Error` if the matrix deviates more (it scales, shears or is not finite), if it mirrors, or if `order`
    /// is not in 1..kMaxOrder.
    ShRotation(int order, const glm::dmat3& rotation);
    /// Creates the rotation of the quaternion `rotation`, which is normalised, for SH vectors of `order`
    /// bands. Throws `Error` if the squared length of `rotation` differs from 1 by more than
    /// `kRotationTolerance`, if `rotation` is not finite, or if `order` is not in 1..kMaxOrder.
    ShRotation(int order, const glm::dquat& rotation);
    /// Returns a rotation about the x axis by `angle` radians, counter-clockwise seen from +x towards the
    /// origin. Throws `Error` for an invalid order or an angle that is not finite.
    static ShRotation about_x(int order, double angle);
    /// Returns a rotation about the y axis by `angle` radians, counter-clockwise seen from +y towards the
    /// origin. Throws `Error` for an invalid order or an angle that is not finite.
    static ShRotation about_y(int order, double angle);
    /// Returns a rotation about the z axis by `angle` radians, counter-clockwise seen from +z towards the
    /// origin. For orders above 3, rotations about z are faster to apply than others. Throws `Error` for an
    /// invalid order or an angle that is not finite.
    static ShRotation about_z(int order, double angle);

    /// Number of bands that `apply` rotates, as passed to the constructor.
    int order() const { return order_; }
    /// Writes the rotated coefficients of `in` to `out`. Both have at least order()² elements; further
    /// elements are neither read nor written. `in` and `out` may be the same span, but must not overlap
    /// partially.
    void apply(std::span<const float> in, std::span<float> out) const;
    /// Writes the rotated coefficients of `in` to `out`. Both have at least order()² elements; further
    /// elements are neither read nor written. `in` and `out` may be the same span, but must not overlap
    /// partially.
    void apply(std::span<const double> in, std::span<double> out) const;
    /// Rotates the first order()² RGB coefficients in place. At order 6, the rotation of three channels takes
    /// little more time than that of one.
    void apply(std::span<glm::vec3> coefficients) const;
    /// Writes the rotated RGB coefficients of `in` to `out`. Both have at least order()² elements; further
    /// elements are neither read nor written. `in` and `out` may overlap in any way.
    void apply(std::span<const glm::vec3> in, std::span<glm::vec3> out) const;

    /// A rotation by an angle a about one axis: cos(m a) and sin(m a) for m = 0..order-1. Implementation
    /// detail.
    struct Rotation {
        /// Index of the entry for m = 0. The three entries before it are 0; SIMD code reads them as padding.
        static constexpr std::size_t kZero = 3;
        /// Cosine and sine of m a at index kZero + m. Entries for m >= order may be uninitialised.
        std::array<double, kZero + kMaxOrder> cosine, sine;
        Rotation() {} // leaves all entries uninitialised
    };
    /// Decomposition R = R_z(last) R_y(tilt) R_z(first), used only for orders above 3; for lower orders it
    /// may be uninitialised. Implementation detail.
    struct Rotations {
        Rotation first, tilt, last; ///< factors in the sequence of their application: about z, y and z
        /// False if R is a rotation about z, equal to `first`; `tilt` and `last` are then not used.
        bool tilted = false;
    };

private:
    int order_;
    glm::dmat3 matrix_;   ///< R; rotates bands 1 and 2
    Rotations rotations_; ///< rotates the higher bands, and band 2 of one channel for orders above 3
};

} // namespace prt
