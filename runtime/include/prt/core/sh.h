#pragma once

// Spherical harmonics: basis values, the clamped-cosine lobe, windows, sums and products.
// prt/core/sh_rotation.h has rotation. Conventions: docs/math.md, section 1. All functions are thread-safe.
// They allocate memory only if they throw, and for tables in the first calls of `sh_product` and
// `sh_product_matrix`. Only `check_order` checks its argument; the other functions require an order
// in 1..kMaxOrder, unit directions, and output spans that have at least the stated length. Stable.

#include "prt/core/glm_layout.h"
#include "prt/core/sh_basis.h"

#include <glm/vec3.hpp>

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>

namespace prt {

/// Throws `Error` unless 1 <= order <= kMaxOrder; otherwise does nothing.
void check_order(int order);

/// Writes the value of each of the order² basis functions in unit direction `direction` to `basis` [order²],
/// at index l(l+1) + m for Y_lm, -l <= m <= l. Computes in float.
void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis);
/// Writes the value of each of the order² basis functions in unit direction `direction` to `basis` [order²],
/// at index l(l+1) + m for Y_lm, -l <= m <= l. Computes in double.
void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis);

/// Writes the basis values in each of the unit directions `directions` to `basis`
/// [order²][directions.size()]: all values of one basis function are contiguous. Evaluates several directions
/// at once, which is several times faster than one call per direction.
void evaluate_sh(int order, std::span<const glm::vec3> directions, std::span<float> basis);

/// Writes the clamped-cosine lobe to `lobe` [order²]: element i is (1/pi) ∫ max(n·w, 0) Y_i(w) dw, with n the
/// unit normal `normal`. The lobe is the transfer vector of an unoccluded receiver of albedo 1
/// (docs/math.md, eq. 8; Ramamoorthi and Hanrahan 2001, eq. 8).
void clamped_cosine_lobe(int order, const glm::dvec3& normal, std::span<double> lobe);

/// Returns A_l / pi for band l, any l >= 0. A_l is the factor by which convolution with the clamped cosine
/// max(cos, 0) multiplies the coefficients of band l. The result is 1 for l = 0, 2/3 for l = 1, 1/4 for l =
/// 2, and 0 for odd l > 1.
double clamped_cosine_factor(int l);

/// Returns the factor of the Hann window for band l >= 0: (1 + cos(pi l / width)) / 2 for l < width, else 0.
/// `width` > 0 is the band, possibly fractional, at which the factor reaches 0; infinity: the factor is 1 for
/// every band.
/// Multiplication of the coefficients of each band with its factor reduces ringing (Sloan 2008, "Stupid SH
/// Tricks").
double hann_window(int l, double width);
/// Returns the factor of the Lanczos window for band l >= 0: 1 for l = 0, sin(t) / t with t = pi l / width
/// for 0 < l < width, else 0. `width` > 0 is the band, possibly fractional, at which the factor reaches 0;
/// infinity: the factor is 1 for every band.
/// Multiplication of the coefficients of each band with its factor reduces ringing (Sloan 2008, "Stupid SH
/// Tricks").
double lanczos_window(int l, double width);

/// Computes out = a + b, element by element. All three spans have the same length; `out` may be `a` or `b`.
template <class Real>
void sh_add(std::span<const Real> a, std::type_identity_t<std::span<const Real>> b, std::span<Real> out) {
    assert(a.size() == b.size() && a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = a[i] + b[i];
}

/// Computes out = factor · a, element by element. `a` and `out` have the same length; `out` may be `a`.
template <class Real>
void sh_scale(std::span<const Real> a, std::type_identity_t<Real> factor, std::span<Real> out) {
    assert(a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = factor * a[i];
}

/// Returns the integral over all directions ∫ a(w) b(w) dw of two functions with the SH coefficients `a` and
/// `b`, which have the same length. This is the sum of the products of their coefficients, because the basis
/// is orthonormal.
template <class Real>
Real sh_dot(std::span<const Real> a, std::type_identity_t<std::span<const Real>> b) {
    assert(a.size() == b.size());
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

/// Returns the value of the function with the coefficients `function` [order²] in unit direction `direction`.
/// The span must have exactly order² elements.
float sh_value(int order, std::span<const float> function, const glm::vec3& direction);
/// Returns the value of the function with the coefficients `function` [order²] in unit direction `direction`.
/// The span must have exactly order² elements.
double sh_value(int order, std::span<const double> function, const glm::dvec3& direction);

/// Writes the first `order` bands of the product a(w) b(w) to `out`, exact up to rounding
/// (docs/math.md, eq. 5): for example shadow times light, or light times the transmittance of an object. `a`,
/// `b` and `out` are [order²]; `out` may be `a` or `b`. The first call for an order of 4 to 6 and the first
/// call for an order above 6 build tables, which allocates memory. Equivalent to D3DXSHMultiply2 to 6.
void sh_product(int order, std::span<const float> a, std::span<const float> b, std::span<float> out);
/// Writes the first `order` bands of the product a(w) b(w) to `out`, exact up to rounding
/// (docs/math.md, eq. 5). `a`, `b` and `out` are [order²]; `out` may be `a` or `b`. The first call for an
/// order above 3 builds tables, which allocates memory, unless `sh_product_matrix` has built them.
void sh_product(int order, std::span<const double> a, std::span<const double> b, std::span<double> out);

/// Writes the matrix M of the product with `function` [order²] to `matrix` [order²][order²]: row i, column j
/// contains ∫ f(w) Y_i(w) Y_j(w) dw. M is symmetric. M g equals `sh_product` of f and g; a caller with many
/// functions g forms M once. The first call builds tables, which allocates memory, unless `sh_product` for
/// double has built them.
void sh_product_matrix(int order, std::span<const double> function, std::span<double> matrix);

} // namespace prt
