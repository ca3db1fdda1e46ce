#pragma once

// Light that leaves the receivers of a plan after all bounces.

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/lamp_bounces.h"
#include "bake/pipeline/light_transport.h"
#include "bake/plan/plan.h"

namespace prt {

/// Optional work of a bake in addition to bounces between receivers; null: not done. `noise` is needed if
/// `measured` has halves of rays or rows of lamps.
struct OptionalWork {
    const GatherOperator* points = nullptr;      ///< gathers at points where errors are measured
    const NoiseFilter* filter = nullptr;         ///< filters light at receivers
    const std::vector<bool>* left_out = nullptr; ///< [receivers] receivers whose own rays do not determine
                                                 ///< their light
    BakeNoise* noise = nullptr;                  ///< receives the noise that is left
};

/// Computes exit transfer of the scene's receivers in its terms: direct light, and all bounces with
/// subsurface scattering. Moves the light out of `measured`. Member `optional_work` of the result is the
/// light at `points`.
Propagated propagate_all(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                         const OptionalWork& optional_work, const Progress& progress);

/// Computes exit light of lamps without sharp features for all receivers of the plan, on both sides of
/// surfaces, after `bounces` bounces. Throws `Error` if endless bounces do not converge.
Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress);

/// Computes exit light of lamps after all bounces for the scene's receivers. Moves the light out of
/// `measured`. Throws `Error` if endless bounces do not converge.
Propagated propagate_lamps(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                           const OptionalWork& optional_work, const Progress& progress);

} // namespace prt
