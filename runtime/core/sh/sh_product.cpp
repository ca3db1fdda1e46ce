// Multiplies functions on the sphere at the nodes of a product quadrature: Gauss-Legendre in the cosine of
// the polar angle, uniform in the azimuth. The nodes of one azimuth are the lanes of one vector.

#include "prt/core/sh.h"
#include "runtime/core/sh/gauss_legendre.h"
#include "runtime/core/sh/triple_product.h"
#include "runtime/core/support/vector_lanes.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

namespace prt {
namespace {

using std::numbers::pi;

/// Number of rings (nodes in the cosine of the polar angle) that integrate a · b · Y_lm exactly.
constexpr int ring_count(int order) {
    return 3 * (order - 1) / 2 + 1;
}
constexpr int azimuth_count(int order) {
    return 3 * (order - 1) + 1;
}
/// Number of azimuths from 0 to pi; the others mirror them.
constexpr int half_count(int order) {
    return azimuth_count(order) / 2 + 1;
}

template <class Real, int Lanes>
struct RingsOf;
template <>
struct RingsOf<float, 8> {
    using type [[gnu::vector_size(32)]] = float;
};
template <>
struct RingsOf<float, 16> {
    using type [[gnu::vector_size(64)]] = float;
};
template <>
struct RingsOf<double, 16> {
    using type [[gnu::vector_size(128)]] = double;
};

/// Tables of one order. Unused rings have weight 0.
template <class Real, int Lanes>
struct ProductTables {
    using Rings = typename RingsOf<Real, Lanes>::type;

    Real legendre[kMaxOrder * kMaxOrder][Lanes] = {}; ///< at [sh_index(l, m)], m >= 0
    Real weights[Lanes] = {};                         ///< including the step of the azimuth
    std::vector<Real> cosine, sine;                   ///< [half][order]

    explicit ProductTables(int order) {
        const int azimuths = azimuth_count(order);
        const GaussLegendre rings(ring_count(order));
        std::array<double, kMaxOrder * kMaxOrder> basis{};
        for (std::size_t r = 0; r < rings.nodes.size(); ++r) {
            const double z = rings.nodes[r];
            evaluate_sh(order, glm::dvec3(std::sqrt(1 - z * z), 0, z), std::span<double>(basis));
            for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(order)); ++i)
                legendre[i][r] = static_cast<Real>(basis[i]);
            weights[r] = static_cast<Real>(rings.weights[r] * 2 * pi / azimuths);
        }
        for (int j = 0; j < half_count(order); ++j)
            for (int m = 0; m < order; ++m) {
                cosine.push_back(static_cast<Real>(std::cos(2 * pi * j * m / azimuths)));
                sine.push_back(static_cast<Real>(std::sin(2 * pi * j * m / azimuths)));
            }
    }
};

/// Loads the rings of one azimuth.
template <class Real, int Lanes>
[[gnu::always_inline]] inline typename RingsOf<Real, Lanes>::type rings_at(const Real (&values)[Lanes]) {
    typename RingsOf<Real, Lanes>::type rings;
    std::memcpy(&rings, values, sizeof rings);
    return rings;
}

/// Returns the tables of an order; those of all orders of a width are created at the first call.
template <class Real, int Lanes>
const ProductTables<Real, Lanes>& tables_of(int order) {
    static const std::vector<ProductTables<Real, Lanes>> all = [] {
        std::vector<ProductTables<Real, Lanes>> tables;
        for (int n = 1; n <= kMaxOrder && ring_count(n) <= Lanes; ++n)
            tables.emplace_back(n);
        return tables;
    }();
    return all[static_cast<std::size_t>(order - 1)];
}

/// Values of a function at all nodes: at azimuth j and at -j.
template <class Real, int Lanes>
struct Nodes {
    typename ProductTables<Real, Lanes>::Rings plus[half_count(kMaxOrder)], minus[half_count(kMaxOrder)];
};

template <class Real, int Lanes>
[[gnu::always_inline]] inline void to_nodes(int order, const ProductTables<Real, Lanes>& t, const Real* c,
                                            Nodes<Real, Lanes>& at) {
    using Rings = typename ProductTables<Real, Lanes>::Rings;
    Rings cosine[kMaxOrder], sine[kMaxOrder];
    for (int m = 0; m < order; ++m) {
        cosine[m] = sine[m] = Rings{};
        for (int l = m; l < order; ++l) {
            const Rings legendre = rings_at(t.legendre[sh_index(l, m)]);
            cosine[m] += c[sh_index(l, m)] * legendre;
            sine[m] += c[sh_index(l, -m)] * legendre;
        }
    }
    const Real *cosines = t.cosine.data(), *sines = t.sine.data();
    for (int j = 0; j < half_count(order); ++j, cosines += order, sines += order) {
        Rings even = cosine[0], odd = {};
        for (int m = 1; m < order; ++m) {
            even += cosines[m] * cosine[m];
            odd += sines[m] * sine[m];
        }
        at.plus[j] = even + odd;
        at.minus[j] = even - odd;
    }
}

template <class Real, int Lanes>
[[gnu::always_inline]] inline void from_nodes(int order, const ProductTables<Real, Lanes>& t,
                                              const Nodes<Real, Lanes>& at, Real* c) {
    using Rings = typename ProductTables<Real, Lanes>::Rings;
    Rings cosine[kMaxOrder] = {}, sine[kMaxOrder] = {};
    const Real *cosines = t.cosine.data(), *sines = t.sine.data();
    for (int j = 0; j < half_count(order); ++j, cosines += order, sines += order) {
        const bool alone = j == 0 || 2 * j == azimuth_count(order); // azimuth 0, and pi if it is a node
        const Rings even = alone ? at.plus[j] : at.plus[j] + at.minus[j];
        const Rings odd = alone ? Rings{} : at.plus[j] - at.minus[j];
        for (int m = 0; m < order; ++m) {
            cosine[m] += cosines[m] * even;
            sine[m] += sines[m] * odd;
        }
    }
    const auto total = [](const Rings& values) __attribute__((always_inline)) {
        Real sum = 0;
        for (int r = 0; r < Lanes; ++r)
            sum += values[r];
        return sum;
    };
    const Rings weights = rings_at(t.weights);
    for (int m = 0; m < order; ++m)
        for (int l = m; l < order; ++l) {
            const Rings legendre = rings_at(t.legendre[sh_index(l, m)]) * weights;
            c[sh_index(l, -m)] = total(sine[m] * legendre);
            c[sh_index(l, m)] = total(cosine[m] * legendre);
        }
}

template <class Real, int Lanes>
[[gnu::always_inline]] inline void product_of(int order, const ProductTables<Real, Lanes>& t, const Real* a,
                                              const Real* b, Real* out) {
    Nodes<Real, Lanes> first, second;
    to_nodes(order, t, a, first);
    to_nodes(order, t, b, second);
    for (int j = 0; j < half_count(order); ++j) {
        first.plus[j] *= second.plus[j];
        first.minus[j] *= second.minus[j];
    }
    from_nodes(order, t, first, out);
}

/// Computes row k of the product of two functions of Order bands, from the pairs a_i b_j + a_j b_i. Zero
/// factors cost no time.
template <int Order, std::size_t K, class Real>
[[gnu::always_inline]] inline Real triple_row(const Real* pairs) {
    constexpr std::size_t kCount = Order * Order;
    Real sum = 0;
    const auto add = [&]<std::size_t Pair>() __attribute__((always_inline)) {
        constexpr std::size_t i = Pair / kCount, j = Pair % kCount;
        if constexpr (i <= j) {
            constexpr double factor = kTripleProducts.at(i, j, K);
            if constexpr (factor != 0)
                sum += static_cast<Real>(factor) * pairs[Pair];
        }
    };
    [&]<std::size_t... Pair>(std::index_sequence<Pair...>) __attribute__((always_inline)) {
        (add.template operator()<Pair>(), ...);
    }
    (std::make_index_sequence<kCount * kCount>());
    return sum;
}

/// Multiplies by the table of triple products, which is short for few bands.
template <int Order, class Real>
[[gnu::always_inline]] inline void short_product(const Real* a, const Real* b, Real* out) {
    constexpr std::size_t kCount = Order * Order;
    Real pairs[kCount * kCount];
#pragma GCC unroll 9
    for (std::size_t i = 0; i < kCount; ++i) {
        pairs[i * kCount + i] = a[i] * b[i];
#pragma GCC unroll 9
        for (std::size_t j = i + 1; j < kCount; ++j)
            pairs[i * kCount + j] = a[i] * b[j] + a[j] * b[i];
    }
    [&]<std::size_t... K>(std::index_sequence<K...>) __attribute__((always_inline)) {
        const Real rows[] = {triple_row<Order, K>(pairs)...};
        ((out[K] = rows[K]), ...);
    }
    (std::make_index_sequence<kCount>());
}

constexpr int kShortOrder = 3;

template <class Real>
[[gnu::always_inline]] inline void product_by_table(int order, const Real* a, const Real* b, Real* out) {
    if (order == 3)
        short_product<3>(a, b, out);
    else if (order == 2)
        short_product<2>(a, b, out);
    else
        short_product<1>(a, b, out);
}

PRT_TWO_CLONES
void short_float_product(int order, const float* a, const float* b, float* out) {
    product_by_table(order, a, b, out);
}

constexpr int kFewRings = 8, kManyRings = 16;

PRT_TWO_CLONES
void float_product(int order, const float* a, const float* b, float* out) {
    if (ring_count(order) <= kFewRings)
        product_of(order, tables_of<float, kFewRings>(order), a, b, out);
    else
        product_of(order, tables_of<float, kManyRings>(order), a, b, out);
}

void double_product(int order, const double* a, const double* b, double* out) {
    product_of(order, tables_of<double, kManyRings>(order), a, b, out);
}

} // namespace

void sh_product(int order, std::span<const float> a, std::span<const float> b, std::span<float> out) {
    if (order <= kShortOrder)
        short_float_product(order, a.data(), b.data(), out.data());
    else
        float_product(order, a.data(), b.data(), out.data());
}

void sh_product(int order, std::span<const double> a, std::span<const double> b, std::span<double> out) {
    if (order <= kShortOrder)
        product_by_table(order, a.data(), b.data(), out.data());
    else
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
