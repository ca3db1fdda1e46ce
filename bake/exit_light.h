#pragma once

// Light that leaves the receivers of a plan, after all bounces.

#include "lamps/lamp_bounces.h"
#include "measured_light.h"
#include "plan.h"
#include "transport/light_transport.h"

namespace prt {

/// Optional work of a bake beside bounces between receivers; null: not done. `noise` is needed where
/// `measured` has halves of rays or rows of lamps.
struct Beside {
    const GatherOperator* points = nullptr;      ///< gathers at points where errors are measured
    const NoiseFilter* filter = nullptr;         ///< of light at receivers
    const std::vector<bool>* left_out = nullptr; ///< [receivers] those whose rays do not tell their light
    BakeNoise* noise = nullptr;                  ///< takes what is left
};

/// Exit transfer of the scene's receivers in its parts: direct, and all bounces and subsurface scattering.
/// Takes the light out of `measured`. Propagated::beside: light at `points`.
Propagated propagate_all(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                         const Beside& beside, const Progress& progress);

/// Smooth exit light of lamps of all receivers of the plan, on both sides of surfaces, after `bounces`
/// bounces. Throws `Error` where endless bounces do not converge.
Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress);

/// Exit light of lamps after all bounces, of the scene's receivers, as above. Throws `Error` where endless
/// bounces do not converge.
Propagated propagate_lamps(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                           const Beside& beside, const Progress& progress);

} // namespace prt
