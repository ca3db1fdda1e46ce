#pragma once

// Direct light measured by samples over the surface, and fitted to receivers.

#include "direct.h"
#include "record.h"
#include "surface/surface_fit.h"

namespace prt {

struct FittedLight {
    DirectLight direct; ///< smooth values of receivers; the rows of its gather are those of the samples
    SampledLight sky;   ///< the same at the samples, of one channel
    SurfaceFit fit;
    SealedIn sealed; ///< receivers without a sample outside of geometry
};

/// Divides the rays of receivers among `samples` each. The gather operator keeps references to `plan`.
FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, int samples, const Progress& progress);

} // namespace prt
