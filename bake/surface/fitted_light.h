#pragma once

// Direct light measured by samples over the surface, and fitted to receivers.

#include "direct.h"
#include "record.h"
#include "surface/surface_fit.h"

namespace prt {

struct FittedLight {
    DirectLight direct; ///< the rows of its gather are those of the samples
    SurfaceFit fit;
    SealedIn sealed; ///< receivers that no sample tells of
};

/// Divides the rays of receivers among `samples` each. The gather operator keeps references to `plan`.
FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, int samples, const Progress& progress);

} // namespace prt
