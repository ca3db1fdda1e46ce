// Values of SH vectors in directions, and convolution with kernels about an axis.
#include "prt/sh_vector.h"

#include "prt/sh.h"

#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

template <class Real, class Direction>
Real value(int order, std::span<const Real> function, const Direction& direction) {
    std::array<Real, kMaxOrder * kMaxOrder> basis;
    evaluate_sh(order, direction, std::span<Real>(basis));
    return sh_dot(function, std::span<const Real>(basis).first(function.size()));
}

template <class Real>
void convolve(int order, std::span<const Real> function, std::span<const Real> kernel, std::span<Real> out) {
    for (int l = 0; l < order; ++l) {
        const Real factor = static_cast<Real>(std::sqrt(4 * std::numbers::pi / (2 * l + 1))) *
                            kernel[static_cast<std::size_t>(l)];
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            out[i] = factor * function[i];
        }
    }
}

} // namespace

float sh_value(int order, std::span<const float> function, const glm::vec3& direction) {
    return value(order, function, direction);
}

double sh_value(int order, std::span<const double> function, const glm::dvec3& direction) {
    return value(order, function, direction);
}

void sh_convolve(int order, std::span<const float> function, std::span<const float> kernel,
                 std::span<float> out) {
    convolve(order, function, kernel, out);
}

void sh_convolve(int order, std::span<const double> function, std::span<const double> kernel,
                 std::span<double> out) {
    convolve(order, function, kernel, out);
}

} // namespace prt
