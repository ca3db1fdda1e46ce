#pragma once

// The real spherical-harmonic basis as a template for any number type: float, double, or a SIMD vector of
// floats. Most callers need `evaluate_sh` of prt/core/sh.h instead. Stable.

#include <array>
#include <cstddef>
#include <numbers>
#include <type_traits>

namespace prt {

/// Maximum order that prtkit supports; the minimum is 1. Order N has the bands l = 0..N-1.
inline constexpr int kMaxOrder = 10;

/// Returns order², the number of SH coefficients of the bands l = 0..order-1.
constexpr int coefficient_count(int order) {
    return order * order;
}

/// Returns l(l+1) + m, the index of the coefficient of band l >= 0 and degree m, -l <= m <= l, in an SH
/// vector of any order above l.
constexpr int sh_index(int l, int m) {
    return l * (l + 1) + m;
}

namespace detail {

/// Returns the square root of `value` >= 0, also at compile time. The result for 0 is 2^-64.
constexpr double square_root(double value) {
    double root = value > 1 ? value : 1;
    for (int i = 0; i < 64; ++i)
        root = 0.5 * (root + value / root);
    return root;
}

/// Constants of the polynomials Q_l^m(z), which are the normalised associated Legendre functions divided by
/// sin^m of the polar angle; z is its cosine. Q includes the factor sqrt(2) of m != 0 and the Condon-Shortley
/// phase (-1)^m (docs/math.md, eq. 3). Constants of bands above kMaxOrder - 1 are 0.
struct LegendreRecurrence {
    std::array<double, kMaxOrder> sectoral{}; ///< [m] Q_m^m, which is constant
    /// [l][m] factors of the recurrence Q_l^m = a[l][m] z Q_{l-1}^m - b[l][m] Q_{l-2}^m for m < l; 0 for
    /// other m.
    std::array<std::array<double, kMaxOrder>, kMaxOrder> a{}, b{};
    /// [m] Q_{m+1}^m = linear[m] z.
    std::array<double, kMaxOrder> linear{};
    /// [m] Q_{m+2}^m = quadratic[m][0] z² - quadratic[m][1], and Q_{m+3}^m = z (cubic[m][0] z² -
    /// cubic[m][1]).
    std::array<std::array<double, 2>, kMaxOrder> quadratic{}, cubic{};

    constexpr LegendreRecurrence() {
        double product = 1;
        for (int m = 0; m < kMaxOrder; ++m) {
            if (m > 0)
                product *= (2.0 * m + 1) / (2.0 * m);
            const double norm = square_root((m > 0 ? 2.0 : 1.0) * product / (4 * std::numbers::pi));
            sectoral[static_cast<std::size_t>(m)] = m % 2 == 0 ? norm : -norm;
        }
        for (int m = 0; m < kMaxOrder; ++m) {
            for (int l = m + 1; l < kMaxOrder; ++l) {
                const double ll = l, mm = m, previous = l - 1;
                const double factor = square_root((4 * ll * ll - 1) / (ll * ll - mm * mm));
                const double inverse =
                    square_root((previous * previous - mm * mm) / (4 * previous * previous - 1));
                a[static_cast<std::size_t>(l)][static_cast<std::size_t>(m)] = factor;
                b[static_cast<std::size_t>(l)][static_cast<std::size_t>(m)] = factor * inverse;
            }
        }
        for (std::size_t m = 0; m + 1 < kMaxOrder; ++m) {
            linear[m] = a[m + 1][m] * sectoral[m];
            if (m + 2 < kMaxOrder)
                quadratic[m] = {a[m + 2][m] * linear[m], b[m + 2][m] * sectoral[m]};
            if (m + 3 < kMaxOrder)
                cubic[m] = {a[m + 3][m] * quadratic[m][0],
                            a[m + 3][m] * quadratic[m][1] + b[m + 3][m] * linear[m]};
        }
    }
};

/// The constants of Q_l^m for all bands up to kMaxOrder - 1.
inline constexpr LegendreRecurrence kLegendre;

/// Type of one number of `Real`: the element of a SIMD vector, or `Real` itself if it is float or double.
template <class Real>
struct ScalarOf {
    using type = std::remove_cvref_t<decltype(std::declval<Real>()[0])>;
};
template <class Real>
requires std::is_floating_point_v<Real>
struct ScalarOf<Real> {
    using type = Real;
};

} // namespace detail

/// Value of the basis function of band 0 in every direction: 1 / (2 sqrt(pi)) = 0.2821.
inline constexpr double kY00 = detail::kLegendre.sectoral[0];

/// Writes the values of the Order² basis functions in unit direction (x, y, z) to `basis` [Order²], at index
/// `sh_index(l, m)`. The basis is real and orthonormal, includes the Condon-Shortley phase (-1)^m, and has
/// the polar axis z (docs/math.md, eq. 1 to 3). `Order` is 1..kMaxOrder. If `Real` is a SIMD vector, each
/// lane is one direction.
template <int Order, class Real>
[[gnu::always_inline]] inline void sh_basis(const Real& x, const Real& y, const Real& z, Real* basis) {
    using Scalar = typename detail::ScalarOf<Real>::type;
    constexpr auto& k = detail::kLegendre;
    const Real z2 = z * z;
    Real cosine = x, sine = y; // sin^m cos(m phi), sin^m sin(m phi)
#pragma GCC unroll 10
    for (int m = 0; m < Order; ++m) {
        const auto mi = static_cast<std::size_t>(m);
        if (m > 1) {
            const Real rotated = x * cosine - y * sine;
            sine = x * sine + y * cosine;
            cosine = rotated;
        }
        Real before = Real{}, legendre = Real{}, next;
#pragma GCC unroll 10
        for (int l = m; l < Order; ++l) {
            const auto li = static_cast<std::size_t>(l);
            switch (l - m) { // the first three after the sectoral one are polynomials in z
            case 0:
                next = Real{} + static_cast<Scalar>(k.sectoral[mi]);
                break;
            case 1:
                next = static_cast<Scalar>(k.linear[mi]) * z;
                break;
            case 2:
                next = static_cast<Scalar>(k.quadratic[mi][0]) * z2 - static_cast<Scalar>(k.quadratic[mi][1]);
                break;
            case 3:
                next = z * (static_cast<Scalar>(k.cubic[mi][0]) * z2 - static_cast<Scalar>(k.cubic[mi][1]));
                break;
            default:
                next = static_cast<Scalar>(k.a[li][mi]) * (z * legendre) -
                       static_cast<Scalar>(k.b[li][mi]) * before;
            }
            before = legendre;
            legendre = next;
            if (m == 0) {
                basis[sh_index(l, 0)] = legendre;
            } else {
                basis[sh_index(l, m)] = legendre * cosine;
                basis[sh_index(l, -m)] = legendre * sine;
            }
        }
    }
}

/// Calls `body.operator()<N>()` with N = order as a template argument, and returns its result. `order` must
/// be in 1..kMaxOrder, which is not checked. The results for all N must have the same type.
template <class Body>
[[gnu::always_inline]] inline decltype(auto) with_order(int order, Body&& body) {
    switch (order) {
    case 1:
        return body.template operator()<1>();
    case 2:
        return body.template operator()<2>();
    case 3:
        return body.template operator()<3>();
    case 4:
        return body.template operator()<4>();
    case 5:
        return body.template operator()<5>();
    case 6:
        return body.template operator()<6>();
    case 7:
        return body.template operator()<7>();
    case 8:
        return body.template operator()<8>();
    case 9:
        return body.template operator()<9>();
    default:
        return body.template operator()<10>();
    }
}

} // namespace prt
