#pragma once

// Light as a bake measures it, before it bounces.

#include "direct.h"
#include "lamps/lamp_light.h"
#include "record.h"
#include "scene/shared_places.h"
#include "surface/surface_fit.h"

#include <optional>

namespace prt {

/// Direct light, and how it becomes that of receivers.
struct Measured {
    DirectLight direct;
    SealedIn sealed;
    std::optional<SurfaceFit> fit; ///< none: measured at receivers
    SampledLight sky;              ///< direct light at its samples
    std::optional<SharedPlaces> shared =
        {}; ///< of receivers, to take means over at the end; none: a fit does
};

/// Light of lamps without a bounce, of the receivers of a plan.
struct MeasuredLamps {
    LampLight light;      ///< smooth where there is a fit
    SampledLight sampled; ///< the same at the samples of a fit
};

/// Measures where `plan.options.fit` says. Rays that were spent on finding out where count in `statistics`.
Measured measure(const BakePlan& plan, Tracer& tracer, BakeStatistics& statistics, const Progress& progress);

/// Light of the plan's lamps at its receivers, by samples of `fit` where there is one.
MeasuredLamps measure_lamps(const BakePlan& plan, Tracer& tracer, const std::optional<SurfaceFit>& fit,
                            const Progress& progress);

} // namespace prt
