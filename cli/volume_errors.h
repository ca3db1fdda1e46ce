#pragma once

// Errors of volumes at places in free space, against path tracing.

#include "budget/budget_lights.h"
#include "inputs.h"
#include "report/report.h"
#include "session.h"

namespace prt::cli {

struct VolumeErrorsRequest {
    Path baked, shipped; ///< shipped: empty where there is none
    GltfOptions reading; ///< of `shipped`
    BudgetLightOptions lights;
    std::vector<std::string> no_shadow; ///< materials that the bake let light through
};

/// Adds a table of errors by light and by distance from surfaces, of the volume of `baked` and of the shipped
/// one. Throws `Error` where there are none, and where they are of two scenes.
void add_volume_errors(VolumeErrorsRequest request, SceneFile& baked, Report& report, Session& session);

} // namespace prt::cli
