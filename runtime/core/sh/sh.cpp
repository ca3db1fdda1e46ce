// Evaluates the SH basis in one or many directions, the clamped-cosine lobe, and windows.
#include "prt/core/sh.h"

#include "prt/core/error.h"
#include "runtime/core/support/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

namespace prt {

using std::numbers::pi;

void check_order(int order) {
    if (order < 1 || order > kMaxOrder)
        throw Error("order " + std::to_string(order) + " is not in 1.." + std::to_string(kMaxOrder));
}

namespace {

/// Orders above this use the code of the maximum order.
constexpr int kMaxUnrolledOrder = 6;

PRT_TWO_CLONES
void evaluate_one(int order, const glm::vec3& direction, float* basis) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            if constexpr (Order <= kMaxUnrolledOrder || Order == kMaxOrder)
                sh_basis<Order>(direction.x, direction.y, direction.z, basis);
        });
}

} // namespace

void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis) {
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    assert(basis.size() >= count);
    if (order <= kMaxUnrolledOrder)
        return evaluate_one(order, direction, basis.data());
    std::array<float, kMaxOrder * kMaxOrder> all;
    evaluate_one(kMaxOrder, direction, all.data());
    std::copy_n(all.begin(), count, basis.begin());
}

/// Precision matters more than speed here: one instance of the code, for the maximum order, serves all
/// orders.
void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis) {
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    assert(basis.size() >= count);
    std::array<double, kMaxOrder * kMaxOrder> all;
    sh_basis<kMaxOrder>(direction.x, direction.y, direction.z, all.data());
    std::copy_n(all.begin(), count, basis.begin());
}

namespace {

/// Evaluates up to kLaneCount directions; `stride` is the distance in floats between successive coefficients.
///
/// The recurrence duplicates `sh_basis` with a run-time order: `sh_basis` for ten orders and three vector
/// widths is 213 kB of code instead of 10 (GCC 12, -O2).
[[gnu::always_inline]] inline void evaluate_lanes(int order, const glm::vec3* directions, std::size_t count,
                                                  float* basis, std::size_t stride) {
    constexpr auto& k = detail::kLegendre;
    Lanes x{}, y{}, z{};
    for (std::size_t lane = 0; lane < count; ++lane) {
        x[lane] = directions[lane].x;
        y[lane] = directions[lane].y;
        z[lane] = directions[lane].z;
    }
    const auto store = [&](int index, const Lanes& value) __attribute__((always_inline)) {
        float* to = basis + static_cast<std::size_t>(index) * stride;
        if (count == kLaneCount)
            *reinterpret_cast<LanesInMemory*>(to) = value;
        else
            for (std::size_t lane = 0; lane < count; ++lane)
                to[lane] = value[lane];
    };
    Lanes cosine = x, sine = y; // sin^m cos(m phi), sin^m sin(m phi)
    for (int m = 0; m < order; ++m) {
        const auto mi = static_cast<std::size_t>(m);
        if (m > 1) {
            const Lanes rotated = x * cosine - y * sine;
            sine = x * sine + y * cosine;
            cosine = rotated;
        }
        Lanes before{}, legendre = Lanes{} + static_cast<float>(k.sectoral[mi]);
        for (int l = m;; ++l) {
            if (m == 0) {
                store(sh_index(l, 0), legendre);
            } else {
                store(sh_index(l, m), legendre * cosine);
                store(sh_index(l, -m), legendre * sine);
            }
            if (l + 1 == order)
                break;
            const auto next_l = static_cast<std::size_t>(l + 1);
            const Lanes next = static_cast<float>(k.a[next_l][mi]) * (z * legendre) -
                               static_cast<float>(k.b[next_l][mi]) * before;
            before = legendre;
            legendre = next;
        }
    }
}

PRT_TARGET_CLONES
void evaluate_many(int order, const glm::vec3* directions, std::size_t count, float* basis) {
    std::size_t first = 0;
    for (; first + kLaneCount <= count; first += kLaneCount)
        evaluate_lanes(order, directions + first, kLaneCount, basis + first, count);
    if (first < count)
        evaluate_lanes(order, directions + first, count - first, basis + first, count);
}

} // namespace

void evaluate_sh(int order, std::span<const glm::vec3> directions, std::span<float> basis) {
    assert(basis.size() >= directions.size() * static_cast<std::size_t>(coefficient_count(order)));
    evaluate_many(order, directions.data(), directions.size(), basis.data());
}

double clamped_cosine_factor(int l) {
    if (l == 0)
        return 1;
    if (l == 1)
        return 2.0 / 3.0;
    if (l % 2 == 1)
        return 0;
    // Ramamoorthi and Hanrahan 2001, eq. 8, divided by pi: 2 (-1)^(l/2-1) / ((l+2)(l-1)) · l! / (2^l
    // (l/2)!²).
    double binomial = 1;
    for (int i = 1; i <= l / 2; ++i)
        binomial *= (l / 2.0 + i) / (4.0 * i);
    const double sign = (l / 2) % 2 == 1 ? 1 : -1;
    return sign * 2 * binomial / ((l + 2.0) * (l - 1.0));
}

void clamped_cosine_lobe(int order, const glm::dvec3& normal, std::span<double> lobe) {
    evaluate_sh(order, normal, lobe);
    for (int l = 0; l < order; ++l)
        for (int m = -l; m <= l; ++m)
            lobe[static_cast<std::size_t>(sh_index(l, m))] *= clamped_cosine_factor(l);
}

double hann_window(int l, double width) {
    return l < width ? 0.5 * (1 + std::cos(pi * l / width)) : 0;
}

double lanczos_window(int l, double width) {
    if (l == 0)
        return 1;
    const double t = pi * l / width;
    if (!(l < width))
        return 0;
    return t > 0 ? std::sin(t) / t : 1; // infinite width
}

} // namespace prt
