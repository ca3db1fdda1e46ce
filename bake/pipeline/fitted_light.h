#pragma once

// Measures direct light with samples over the surface and fits it to receivers.

#include "bake/pipeline/direct.h"
#include "bake/pipeline/record.h"
#include "bake/surface_fit/surface_fit.h"
#include "bake/trace/lamp_light.h"

namespace prt {

/// Light of lamps without a bounce, for the receivers of a plan.
struct MeasuredLamps {
    LampLight light;      ///< smooth values if there is a fit
    SampledLight sampled; ///< light of lamps at the samples of a fit
};
struct FittedLight {
    DirectLight direct; ///< smooth values of receivers; the rows of its gather operator are samples
    SampledLight sky;   ///< direct light at the samples, one channel
    MeasuredLamps lamps;
    SurfaceFit fit;
    SealedIn sealed; ///< receivers without a sample outside geometry
};

/// Divides the rays of each receiver among `samples` samples. With a target error, traces the smallest number
/// of rays whose noise after the fit is at most the target. The gather operator keeps references to `plan`.
/// `known`: connections for the last bounce of lamps that exist already; null: none.
FittedLight trace_fitted(const BakePlan& plan, Tracer& tracer, LastOfLamps last, int samples,
                         const Progress& progress, const LampConnections* known = nullptr);

} // namespace prt
