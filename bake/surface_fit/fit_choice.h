#pragma once

// Decides whether to measure light at vertices or over the surface between them.

#include "bake/plan/plan.h"
#include "bake/trace/tracer.h"

#include <cstddef>

namespace prt {

/// Result of test points between vertices, traced with separate rays. Errors are relative L2 errors of direct
/// light.
struct FitTrial {
    double between = 0;  ///< interpolation error between vertices, noise removed
    double sampling = 0; ///< noise of one receiver's rays
    std::size_t rays = 0;
};

/// Traces the test points.
FitTrial try_fit(const BakePlan& plan, Tracer& tracer, const Progress& progress);

/// Best number of samples that share a receiver's rays, and whether they are better than light at the vertex,
/// which is `filtered`.
struct FitChoice {
    int samples = 1; ///< samples per receiver
    bool better = false;
};

FitChoice choose_fit(const FitTrial& trial, int rays, bool filtered);

} // namespace prt
