#pragma once

// Measures errors of volumes at positions in free space, against path tracing.

#include "cli/pipeline/measure_budget.h"

namespace prt::pipeline {

/// Adds a table of errors by light and by distance from surfaces, for the volume of `baked` and the shipped
/// one. Throws `Error` if there is no volume, or if the volumes belong to different scenes.
void add_volume_errors(BudgetRequest request, SceneFile& baked, Report& report, const Host& host);

} // namespace prt::pipeline
