#include "prt/sh.h"

#include "prt/error.h"

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
void evaluate(int order, const Vector& direction, std::span<Real> basis) {
    assert(basis.size() >= static_cast<std::size_t>(coefficient_count(order)));
    with_order(order,
               [&]<int Order>() { sh_basis<Order>(direction.x, direction.y, direction.z, basis.data()); });
}

} // namespace

void evaluate_sh(int order, const glm::vec3& direction, std::span<float> basis) {
    evaluate(order, direction, basis);
}

void evaluate_sh(int order, const glm::dvec3& direction, std::span<double> basis) {
    evaluate(order, direction, basis);
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
