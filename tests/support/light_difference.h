#pragma once

#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>

namespace prt::test {

/// Largest distance of two coefficients. NaN where a coefficient is.
inline double largest_difference(const Light& a, const Light& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
        const double difference = static_cast<double>(glm::distance(a.coefficients[i], b.coefficients[i]));
        if (!(difference <= largest))
            largest = difference;
        if (std::isnan(largest))
            break;
    }
    return largest;
}

} // namespace prt::test
