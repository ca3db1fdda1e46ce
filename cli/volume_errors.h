#pragma once

// Errors of volumes at places in free space, against path tracing.

#include "budget/measure_budget.h"

namespace prt::cli {

/// Adds a table of errors by light and by distance from surfaces, of the volume of `baked` and of the shipped
/// one. Throws `Error` where there are none, and where they are of two scenes.
void add_volume_errors(BudgetRequest request, SceneFile& baked, Report& report, Session& session);

} // namespace prt::cli
