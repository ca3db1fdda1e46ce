#pragma once

// Light that a bake measures before it bounces.

#include "bake/pipeline/direct.h"
#include "bake/pipeline/fitted_light.h"
#include "bake/pipeline/record.h"
#include "bake/scene/shared_positions.h"

#include <optional>

namespace prt {

/// Direct light, and the data that convert it to light at receivers.
struct Measured {
    DirectLight direct;
    MeasuredLamps lamps;
    SealedIn sealed;
    std::optional<SurfaceFit> fit; ///< empty: light is measured at receivers
    SampledLight sky;              ///< direct light at the fit's samples
    /// Groups of receivers to average at the end; empty: a fit replaces them.
    std::optional<SharedPositions> shared = {};
};

/// Measures light at the positions that `plan.options.fit` selects. Rays for this choice are counted in
/// `statistics`. `last`: whether to gather the last bounce of lamps at the same positions
/// (DirectLight::lamps). `known`: connections for this bounce that exist already; null: none.
Measured measure(const BakePlan& plan, Tracer& tracer, LastOfLamps last, BakeStatistics& statistics,
                 const Progress& progress, const LampConnections* known = nullptr);

} // namespace prt
