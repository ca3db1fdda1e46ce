#pragma once

// Functions on the sphere as vectors of SH coefficients [order²]: sums, dot products, products; for float and
// double. All functions are thread-safe and allocate nothing, except tables of `sh_product`. Arguments are
// checked by assert only. Stable.

#include "prt/sh_basis.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>

namespace prt {

/// Computes out = a + b; `out` may be `a` or `b`.
template <class Real>
void sh_add(std::span<const Real> a, std::type_identity_t<std::span<const Real>> b, std::span<Real> out) {
    assert(a.size() == b.size() && a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = a[i] + b[i];
}

/// Computes out = factor a; `out` may be `a`.
template <class Real>
void sh_scale(std::span<const Real> a, std::type_identity_t<Real> factor, std::span<Real> out) {
    assert(a.size() == out.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        out[i] = factor * a[i];
}

/// Returns ∫ a(w) b(w) dw; the basis is orthonormal.
template <class Real>
Real sh_dot(std::span<const Real> a, std::type_identity_t<std::span<const Real>> b) {
    assert(a.size() == b.size());
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

/// Returns the function's value in unit direction `direction`.
float sh_value(int order, std::span<const float> function, const glm::vec3& direction);
double sh_value(int order, std::span<const double> function, const glm::dvec3& direction);

/// Computes the first `order` bands of the product of two functions of `order` bands, exact up to rounding:
/// for example shadow times light, or light times the transmittance of an object. Up to order 3 it uses the
/// table of triple products. Higher orders use a quadrature that is exact for three times the degree
/// (docs/math.md, eq. 5), which needs far fewer operations there; its tables are built at the first call.
/// `out` may be `a` or `b`. Equivalent to D3DXSHMultiply2 to 6.
void sh_product(int order, std::span<const float> a, std::span<const float> b, std::span<float> out);
void sh_product(int order, std::span<const double> a, std::span<const double> b, std::span<double> out);

/// Computes the matrix [order²][order²] of the product with `function`: row i, column j hold ∫ f Y_i Y_j.
/// Used for many products with one function, or to transform transfer by it (self-transfer). Symmetric.
void sh_product_matrix(int order, std::span<const double> function, std::span<double> matrix);

} // namespace prt
