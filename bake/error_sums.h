#pragma once

#include "prt/bake.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Errors from squared errors and squared norms at points.
class ErrorSums {
public:
    /// `area`: that the point stands for, m².
    void add(double area, double error, double norm) {
        errors_.push_back(area * error);
        norms_.push_back(area * norm);
        area_ += area;
    }
    std::size_t points() const { return errors_.size(); }
    /// Relative to their own light and to that of `scene` per area.
    BakeErrors::Error relative(const ErrorSums& scene) const;
    BakeErrors::Error relative() const { return relative(*this); }

private:
    std::vector<double> errors_, norms_;
    double area_ = 0;
};

} // namespace prt
