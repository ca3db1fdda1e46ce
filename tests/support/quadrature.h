#pragma once

#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace prt::test {

struct SpherePoint {
    glm::dvec3 direction;
    double weight;
};

/// Product quadrature on the sphere: Gauss-Legendre in z by Newton, uniform in the azimuth. Exact for
/// polynomials of degree below 2 `n`.
std::vector<SpherePoint> sphere_quadrature(int n);

/// Midpoints of n x 2n cells in (z, azimuth) of equal area: for functions with edges.
std::vector<SpherePoint> sphere_cells(int n);

/// ∫ f over the sphere by the points of sphere_cells(n).
double integrate_sphere(int n, const std::function<double(const glm::dvec3&)>& f);

} // namespace prt::test
