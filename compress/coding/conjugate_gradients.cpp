// Conjugate gradients (Hestenes and Stiefel 1952) with diagonal preconditioning. Unlike Eigen's version, it
// stores floats and sums in double in a fixed order, so that a file does not depend on the version of Eigen.

#include "compress/coding/conjugate_gradients.h"

#include "compress/tuning/tuning.h"

namespace prt {

std::vector<float> conjugate_gradients(const std::function<std::vector<float>(std::span<const float>)>& apply,
                                       std::span<const float> inverse_diagonal, std::vector<float> right) {
    std::vector<float>& residual = right;
    std::vector<float> x(residual.size(), 0.0f), direction(residual.size(), 0.0f);
    double before = 0, start = 0;
    for (int step = 0; step < tuning::kMaxSolverSteps; ++step) {
        double norm = 0;
        for (std::size_t i = 0; i < residual.size(); ++i)
            norm += static_cast<double>(residual[i]) * static_cast<double>(residual[i]) *
                    static_cast<double>(inverse_diagonal[i]);
        if (step == 0)
            start = norm;
        if (!(norm > tuning::kSolverTolerance * start))
            break;
        const auto beta = static_cast<float>(step == 0 ? 0 : norm / before);
        before = norm;
        for (std::size_t i = 0; i < residual.size(); ++i)
            direction[i] = residual[i] * inverse_diagonal[i] + beta * direction[i];
        const std::vector<float> product = apply(direction);
        double curvature = 0;
        for (std::size_t i = 0; i < residual.size(); ++i)
            curvature += static_cast<double>(direction[i]) * static_cast<double>(product[i]);
        const auto alpha = static_cast<float>(norm / curvature);
        for (std::size_t i = 0; i < residual.size(); ++i) {
            x[i] += alpha * direction[i];
            residual[i] -= alpha * product[i];
        }
    }
    return x;
}

} // namespace prt
