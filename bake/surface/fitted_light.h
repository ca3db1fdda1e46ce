#pragma once

// Direct light measured by samples over the surface, and fitted to receivers.

#include "direct.h"
#include "lamps/lamp_light.h"
#include "record.h"
#include "surface/surface_fit.h"

namespace prt {

/// Light of lamps without a bounce, of the receivers of a plan.
struct MeasuredLamps {
    LampLight light;      ///< smooth where there is a fit
    SampledLight sampled; ///< the same at the samples of a fit
};
struct FittedLight {
    DirectLight direct; ///< smooth values of receivers; the rows of its gather are those of the samples
    SampledLight sky;   ///< the same at the samples, of one channel
    MeasuredLamps lamps;
    SurfaceFit fit;
    SealedIn sealed; ///< receivers without a sample outside of geometry
};

/// Divides the rays of receivers among `samples` each. The gather operator keeps references to `plan`.
FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, LastOfLamps last, int samples,
                         const Progress& progress);

} // namespace prt
