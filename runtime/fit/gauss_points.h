#pragma once

// Gauss-Legendre quadrature with three points.

#include <array>

namespace prt {

struct GaussPoint {
    double at, weight;
};

/// Returns the three Gauss-Legendre points on [begin, end]: exact to degree 5.
inline std::array<GaussPoint, 3> gauss_points(double begin, double end) {
    constexpr double kOutside = 0.774596669241483377; // sqrt(3 / 5)
    const double half = 0.5 * (end - begin), middle = 0.5 * (begin + end);
    return {{{middle - kOutside * half, half * 5 / 9},
             {middle, half * 8 / 9},
             {middle + kOutside * half, half * 5 / 9}}};
}

} // namespace prt
