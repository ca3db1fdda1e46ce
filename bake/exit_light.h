#pragma once

// Light that leaves the receivers of a plan, after all bounces.

#include "plan.h"
#include "transport/light_transport.h"

namespace prt {

/// Exit transfer of the scene's receivers in its parts: direct, and all bounces and subsurface scattering.
Propagated propagate_all(const BakePlan& plan, Transfer direct, const TransportOperators& operators,
                         const Progress& progress);

/// Exit light of lamps of all receivers of the plan, on both sides of surfaces, with so many bounces. Throws
/// `Error` where it has no end.
Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress);

/// Exit light of lamps, with all bounces, from what they give without: of the scene's receivers. Throws
/// `Error` where it has no end.
Propagated propagate_lamps(const BakePlan& plan, Transfer light, const TransportOperators& operators,
                           const Progress& progress);

} // namespace prt
