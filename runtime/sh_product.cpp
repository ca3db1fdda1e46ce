// Products of functions on the sphere at the nodes of a product quadrature: Gauss-Legendre in the cosine of
// the polar angle, equal steps of the azimuth. The nodes of one azimuth are the lanes of one vector.

#include "gauss_legendre.h"
#include "prt/sh.h"
#include "prt/sh_vector.h"
#include "prt/vector_lanes.h"

#include <array>
#include <cmath>
#include <vector>

namespace prt {
namespace {

using detail::kPi;

template <int Order, class Real>
struct ProductTables {
    static constexpr int kDegree = 3 * (Order - 1); ///< of a · b · Y_lm
    static constexpr int kRings = kDegree / 2 + 1;
    static constexpr int kLanes = kRings <= 4 ? 4 : kRings <= 8 ? 8 : 16;
    static constexpr int kAzimuths = kDegree + 1;
    static constexpr int kHalf = kAzimuths / 2 + 1; ///< azimuths 0 to pi; the others mirror them
    using Rings [[gnu::vector_size(sizeof(Real) * kLanes)]] = Real;

    Rings legendre[coefficient_count(Order)] = {}; ///< at [sh_index(l, m)], m >= 0; 0 in idle lanes
    Rings weights = {};                            ///< of the rings, with the step of the azimuth
    Real cosine[kHalf][Order] = {}, sine[kHalf][Order] = {};

    ProductTables() {
        const GaussLegendre rings(kRings);
        std::array<double, kMaxOrder * kMaxOrder> basis{};
        for (int r = 0; r < kRings; ++r) {
            const double z = rings.nodes[static_cast<std::size_t>(r)];
            evaluate_sh(Order, glm::dvec3(std::sqrt(1 - z * z), 0, z), std::span<double>(basis));
            for (int i = 0; i < coefficient_count(Order); ++i)
                legendre[i][r] = static_cast<Real>(basis[static_cast<std::size_t>(i)]);
            weights[r] = static_cast<Real>(rings.weights[static_cast<std::size_t>(r)] * 2 * kPi / kAzimuths);
        }
        for (int j = 0; j < kHalf; ++j)
            for (int m = 0; m < Order; ++m) {
                cosine[j][m] = static_cast<Real>(std::cos(2 * kPi * j * m / kAzimuths));
                sine[j][m] = static_cast<Real>(std::sin(2 * kPi * j * m / kAzimuths));
            }
    }

    static const ProductTables& get() {
        static const ProductTables tables;
        return tables;
    }
};

/// Whether azimuth j stands for itself alone: 0, and pi where there is one.
template <class Tables>
constexpr bool alone(int j) {
    return j == 0 || 2 * j == Tables::kAzimuths;
}

/// A function at all nodes: at azimuth j and at -j.
template <class Tables>
struct Nodes {
    typename Tables::Rings plus[Tables::kHalf], minus[Tables::kHalf];
};

template <int Order, class Real>
[[gnu::always_inline]] inline void to_nodes(const ProductTables<Order, Real>& t, const Real* c,
                                            Nodes<ProductTables<Order, Real>>& at) {
    using Tables = ProductTables<Order, Real>;
    using Rings = typename Tables::Rings;
    Rings cosine[Order], sine[Order];
#pragma GCC unroll 10
    for (int m = 0; m < Order; ++m) {
        cosine[m] = sine[m] = Rings{};
#pragma GCC unroll 10
        for (int l = m; l < Order; ++l) {
            const Rings legendre = t.legendre[sh_index(l, m)];
            cosine[m] += c[sh_index(l, m)] * legendre;
            if (m > 0)
                sine[m] += c[sh_index(l, -m)] * legendre;
        }
    }
    for (int j = 0; j < Tables::kHalf; ++j) {
        Rings even = cosine[0], odd = {};
#pragma GCC unroll 10
        for (int m = 1; m < Order; ++m) {
            even += t.cosine[j][m] * cosine[m];
            odd += t.sine[j][m] * sine[m];
        }
        at.plus[j] = even + odd;
        at.minus[j] = even - odd;
    }
}

template <int Order, class Real>
[[gnu::always_inline]] inline void from_nodes(const ProductTables<Order, Real>& t,
                                              const Nodes<ProductTables<Order, Real>>& at, Real* c) {
    using Tables = ProductTables<Order, Real>;
    using Rings = typename Tables::Rings;
    Rings cosine[Order], sine[Order];
#pragma GCC unroll 10
    for (int m = 0; m < Order; ++m)
        cosine[m] = sine[m] = Rings{};
    for (int j = 0; j < Tables::kHalf; ++j) {
        const Rings even = alone<Tables>(j) ? at.plus[j] : at.plus[j] + at.minus[j];
        const Rings odd = alone<Tables>(j) ? Rings{} : at.plus[j] - at.minus[j];
#pragma GCC unroll 10
        for (int m = 0; m < Order; ++m) {
            cosine[m] += t.cosine[j][m] * even;
            sine[m] += t.sine[j][m] * odd;
        }
    }
    const auto total = [](const Rings& values) __attribute__((always_inline)) {
        Real sum = 0;
        for (int r = 0; r < Tables::kRings; ++r)
            sum += values[r];
        return sum;
    };
#pragma GCC unroll 10
    for (int m = 0; m < Order; ++m) {
        cosine[m] *= t.weights;
        sine[m] *= t.weights;
#pragma GCC unroll 10
        for (int l = m; l < Order; ++l) {
            const Rings legendre = t.legendre[sh_index(l, m)];
            c[sh_index(l, m)] = total(cosine[m] * legendre);
            if (m > 0)
                c[sh_index(l, -m)] = total(sine[m] * legendre);
        }
    }
}

template <int Order, class Real>
[[gnu::always_inline]] inline void product_of(const ProductTables<Order, Real>& t, const Real* a,
                                              const Real* b, Real* out) {
    using Tables = ProductTables<Order, Real>;
    Nodes<Tables> first, second;
    to_nodes(t, a, first);
    to_nodes(t, b, second);
    for (int j = 0; j < Tables::kHalf; ++j) {
        first.plus[j] *= second.plus[j];
        first.minus[j] *= second.minus[j];
    }
    from_nodes(t, first, out);
}

PRT_TARGET_CLONES
void float_product(int order, const float* a, const float* b, float* out) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            product_of(ProductTables<Order, float>::get(), a, b, out);
        });
}

PRT_TARGET_CLONES
void double_product(int order, const double* a, const double* b, double* out) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            product_of(ProductTables<Order, double>::get(), a, b, out);
        });
}

} // namespace

void sh_product(int order, std::span<const float> a, std::span<const float> b, std::span<float> out) {
    float_product(order, a.data(), b.data(), out.data());
}

void sh_product(int order, std::span<const double> a, std::span<const double> b, std::span<double> out) {
    double_product(order, a.data(), b.data(), out.data());
}

void sh_product_matrix(int order, std::span<const double> function, std::span<double> matrix) {
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    assert(matrix.size() >= count * count);
    std::array<double, kMaxOrder * kMaxOrder> unit{};
    for (std::size_t i = 0; i < count; ++i) {
        unit[i] = 1;
        double_product(order, function.data(), unit.data(), &matrix[i * count]);
        unit[i] = 0;
    }
}

} // namespace prt
