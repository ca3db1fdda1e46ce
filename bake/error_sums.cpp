// Ratio of two sums over random points, and its standard error by the points' deviations from the ratio.

#include "error_sums.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {

BakeErrors::Error ErrorSums::relative() const {
    const double norm = std::accumulate(norms_.begin(), norms_.end(), 0.0);
    if (!(norm > 0) || points() < 2)
        return {};
    const double ratio = std::accumulate(errors_.begin(), errors_.end(), 0.0) / norm;
    double squares = 0;
    for (std::size_t i = 0; i < errors_.size(); ++i) {
        const double off = errors_[i] - ratio * norms_[i];
        squares += off * off;
    }
    // Of the root half as much relative to it as of the square, but where the square is nearly nothing.
    const double spread = std::sqrt(squares) / norm, root = std::sqrt(std::max(ratio, 0.0));
    return {root, std::min(spread / std::max(2 * root, 1e-12), std::sqrt(spread))};
}

} // namespace prt
