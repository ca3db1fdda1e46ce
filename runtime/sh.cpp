#include "prt/sh.h"

#include "prt/error.h"
#include "prt/vector_lanes.h"

#include <cassert>
#include <cmath>
#include <string>

namespace prt {

using detail::kPi;

void check_order(int order) {
    if (order < 1 || order > kMaxOrder)
        throw Error("order " + std::to_string(order) + " is outside 1.." + std::to_string(kMaxOrder));
}

namespace {

template <class Vector, class Real>
[[gnu::always_inline]] inline void evaluate(int order, const Vector& direction, std::span<Real> basis) {
    assert(basis.size() >= static_cast<std::size_t>(coefficient_count(order)));
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            sh_basis<Order>(direction.x, direction.y, direction.z, basis.data());
        });
}

} // namespace

PRT_TARGET_CLONES
void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis) {
    evaluate(order, direction, basis);
}

void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis) {
    evaluate(order, direction, basis);
}

namespace {

/// Up to kLaneCount directions from `first` on; the values of each coefficient go `stride` apart.
template <int Order>
[[gnu::always_inline]] inline void evaluate_lanes(const glm::vec3* directions, std::size_t count,
                                                  float* basis, std::size_t stride) {
    Lanes x{}, y{}, z{}, values[coefficient_count(Order)];
    for (std::size_t lane = 0; lane < count; ++lane) {
        x[lane] = directions[lane].x;
        y[lane] = directions[lane].y;
        z[lane] = directions[lane].z;
    }
    sh_basis<Order>(x, y, z, values);
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(Order)); ++i) {
        if (count == kLaneCount)
            *reinterpret_cast<LanesInMemory*>(basis + i * stride) = values[i];
        else
            for (std::size_t lane = 0; lane < count; ++lane)
                basis[i * stride + lane] = values[i][lane];
    }
}

PRT_TARGET_CLONES
void evaluate_many(int order, const glm::vec3* directions, std::size_t count, float* basis) {
    with_order(
        order, [&]<int Order>() __attribute__((always_inline)) {
            std::size_t first = 0;
            for (; first + kLaneCount <= count; first += kLaneCount)
                evaluate_lanes<Order>(directions + first, kLaneCount, basis + first, count);
            if (first < count)
                evaluate_lanes<Order>(directions + first, count - first, basis + first, count);
        });
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
    return l < width ? 0.5 * (1 + std::cos(kPi * l / width)) : 0;
}

double lanczos_window(int l, double width) {
    if (l == 0)
        return 1;
    const double t = kPi * l / width;
    return l < width ? std::sin(t) / t : 0;
}

} // namespace prt
