// Computes the ratio of two sums over random points, and its standard error from the points' deviations.

#include "bake/pipeline/error_sums.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

} // namespace

BakeErrors::Error ErrorSums::relative(const ErrorSums& scene) const {
    BakeErrors::Error result;
    if (points() < 2)
        return result;
    const double error = std::max(sum(errors_), 0.0), norm = sum(norms_), of_scene = sum(scene.norms_);
    if (of_scene > 0)
        result.of_scene = std::sqrt(error / area_ * scene.area_ / of_scene);
    if (!(norm > 0))
        return result;
    const double ratio = error / norm;
    double squares = 0;
    for (std::size_t i = 0; i < errors_.size(); ++i) {
        const double off = errors_[i] - ratio * norms_[i];
        squares += off * off;
    }
    // The relative error of a square root is half the relative error of the square, except where the square
    // is nearly 0.
    const double spread = std::sqrt(squares) / norm;
    result.relative_l2 = std::sqrt(ratio);
    result.standard_error = std::min(spread / std::max(2 * result.relative_l2, 1e-12), std::sqrt(spread));
    result.known = true;
    return result;
}

} // namespace prt
