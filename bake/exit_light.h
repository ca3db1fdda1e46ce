#pragma once

// Light that leaves the receivers of a plan, after all bounces.

#include "measured_light.h"
#include "plan.h"
#include "transport/light_transport.h"

namespace prt {

/// Exit transfer of the scene's receivers in its parts: direct, and all bounces and subsurface scattering.
/// `sampled`: the same direct light at the samples of a fit, where there is one.
Propagated propagate_all(const BakePlan& plan, Transfer direct, const SampledLight& sampled,
                         const TransportOperators& operators, const Progress& progress);

/// Smooth exit light of lamps of all receivers of the plan, on both sides of surfaces, after `bounces`
/// bounces. Throws `Error` where endless bounces do not converge.
Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress);

/// Exit light of lamps after all bounces, of the scene's receivers. Throws `Error` where endless bounces do
/// not converge.
Propagated propagate_lamps(const BakePlan& plan, MeasuredLamps lamps, const TransportOperators& operators,
                           const Progress& progress);

} // namespace prt
