#pragma once

#include "prt/bake.h"

#include <cstddef>
#include <vector>

namespace prt {

/// A relative error from squared errors and squared norms at points, with its standard error.
class ErrorSums {
public:
    /// `area`: that the point stands for, m².
    void add(double area, double error, double norm) {
        errors_.push_back(area * error);
        norms_.push_back(area * norm);
    }
    std::size_t points() const { return errors_.size(); }
    BakeErrors::Error relative() const;

private:
    std::vector<double> errors_, norms_;
};

} // namespace prt
