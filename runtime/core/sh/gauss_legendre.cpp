// Computes Gauss-Legendre nodes and weights by Newton's method on the recurrence of the Legendre polynomials.
#include "runtime/core/sh/gauss_legendre.h"

#include <cmath>
#include <numbers>

namespace prt {

GaussLegendre::GaussLegendre(int n) {
    for (int i = 0; i < n; ++i) {
        // Newton's method on P_n from an estimate close to the root.
        double t = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
        double derivative = 0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double previous = 1, current = t;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * t * current - (k - 1) * previous) / k;
                previous = current;
                current = next;
            }
            derivative = n * (t * current - previous) / (t * t - 1);
            const double step = current / derivative;
            t -= step;
            if (std::abs(step) < 1e-16)
                break;
        }
        nodes.push_back(t);
        weights.push_back(2 / ((1 - t * t) * derivative * derivative));
    }
}

} // namespace prt
