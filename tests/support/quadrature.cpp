// Integrates functions over the sphere and over intervals.

#include "quadrature.h"

#include <cmath>
#include <numbers>

namespace prt::test {

using std::numbers::pi;

namespace {

glm::dvec3 direction(double z, double phi) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Returns P_n(z) and its derivative, by std::legendre, which the library does not use.
std::pair<double, double> legendre(unsigned n, double z) {
    const double p = std::legendre(n, z), before = std::legendre(n - 1, z);
    return {p, n * (z * p - before) / (z * z - 1)};
}

} // namespace

std::vector<SpherePoint> sphere_quadrature(int n) {
    std::vector<SpherePoint> points;
    for (int i = 0; i < n; ++i) {
        double z = std::cos(pi * (i + 0.75) / (n + 0.5));
        for (int iteration = 0; iteration < 50; ++iteration) {
            const auto [p, derivative] = legendre(static_cast<unsigned>(n), z);
            z -= p / derivative;
        }
        const double derivative = legendre(static_cast<unsigned>(n), z).second;
        const double weight = 2 / ((1 - z * z) * derivative * derivative);
        for (int j = 0; j < 2 * n; ++j)
            points.push_back({direction(z, pi * (j + 0.5) / n), weight * pi / n});
    }
    return points;
}

std::vector<SpherePoint> sphere_cells(int n) {
    std::vector<SpherePoint> points;
    const double weight = 2 * pi / (n * static_cast<double>(n));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j)
            points.push_back({direction(2 * (i + 0.5) / n - 1, pi * (j + 0.5) / n), weight});
    return points;
}

double integrate_sphere(int n, const std::function<double(const glm::dvec3&)>& f) {
    double sum = 0;
    for (const auto& [w, weight] : sphere_cells(n))
        sum += f(w) * weight;
    return sum;
}

} // namespace prt::test
