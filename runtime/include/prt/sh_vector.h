#pragma once

// Functions on the sphere as vectors of SH coefficients [order²]: sums, dot products and products, in float
// and double. All functions are thread-safe. They allocate no memory, except that `sh_product` and
// `sh_product_matrix` build tables at first use and keep them. Arguments are not checked in release builds:
// the order must be in 1..kMaxOrder, and spans must have the stated length. Stable.

#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>

namespace prt {

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
