#pragma once

// Gauss-Legendre quadrature.

#include <vector>

namespace prt {

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1], exact for polynomials of degree 2n - 1.
struct GaussLegendre {
    std::vector<double> nodes, weights;

    explicit GaussLegendre(int n);
};

} // namespace prt
