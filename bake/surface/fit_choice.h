#pragma once

// Whether light is better measured at vertices or over the surface between them.

#include "plan.h"
#include "prt/tracer.h"

#include <cstddef>

namespace prt {

/// What some points between vertices tell, by rays of their own. Errors are relative L2 of direct light.
struct FitTrial {
    double between = 0;  ///< of interpolating between vertices, were these without noise
    double sampling = 0; ///< of the rays of one receiver
    std::size_t rays = 0;
};

FitTrial try_fit(const BakePlan& plan, Tracer& tracer, const Progress& progress);

/// How many samples a receiver's rays are best divided among, and whether that is better than one at the
/// vertex, whose light is `filtered`.
struct FitChoice {
    int samples = 1; ///< for each receiver
    bool better = false;
};

FitChoice choose_fit(const FitTrial& trial, int rays, bool filtered);

} // namespace prt
