#pragma once

// Errors of volumes at places in free space, against path tracing.

#include "budget/budget_lights.h"
#include "inputs.h"
#include "report/report.h"
#include "session.h"

namespace prt::cli {

/// Adds a table of errors by light and by distance from surfaces, of the volume of `baked` and, where there
/// is one, of `shipped`. Nothing where `baked` has no volume. Throws `Error` where volumes are of two scenes.
void add_volume_errors(const SceneFile& baked, const SceneFile* shipped, const BudgetLightOptions& lights,
                       Report& report, Session& session);

} // namespace prt::cli
