#pragma once

// Light as a bake measures it, before it bounces.

#include "direct.h"
#include "record.h"
#include "scene/shared_places.h"
#include "surface/fitted_light.h"

#include <optional>

namespace prt {

/// Direct light, and how it becomes that of receivers.
struct Measured {
    DirectLight direct;
    MeasuredLamps lamps;
    SealedIn sealed;
    std::optional<SurfaceFit> fit; ///< none: measured at receivers
    SampledLight sky;              ///< direct light at its samples
    std::optional<SharedPlaces> shared =
        {}; ///< of receivers, to take means over at the end; none: a fit does
};

/// Measures where `plan.options.fit` says. Rays that were spent on finding out where count in `statistics`.
/// `last`: whether the last bounce of lamps is to be gathered at the same places (DirectLight::lamps).
Measured measure(const BakePlan& plan, Tracer& tracer, LastOfLamps last, BakeStatistics& statistics,
                 const Progress& progress);

} // namespace prt
