#pragma once

// Sums of squared errors over random points.

#include "prt/bake/bake.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Computes relative errors from squared errors and squared norms at points.
class ErrorSums {
public:
    /// Adds a point. `area`: the area that it represents, m².
    void add(double area, double error, double norm) {
        errors_.push_back(area * error);
        norms_.push_back(area * norm);
        area_ += area;
    }
    std::size_t points() const { return errors_.size(); }
    /// Error relative to the light at these points, and to the light of `scene` per area.
    BakeErrors::Error relative(const ErrorSums& scene) const;
    BakeErrors::Error relative() const { return relative(*this); }

private:
    std::vector<double> errors_, norms_;
    double area_ = 0;
};

} // namespace prt
