#pragma once

// The budget of errors of files.

#include "cli/pipeline/budget_lights.h"
#include "cli/pipeline/host.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"

namespace prt::pipeline {

/// Input of `add_budget`.
struct BudgetRequest {
    Path baked;
    FileSource shipped;     ///< compressed file; empty: only the bake is measured
    ReadingOptions reading; ///< options for `shipped`
    BudgetLightOptions lights;
    std::vector<std::string> no_shadow; ///< materials that the bake let light through
};

/// Adds the sources of the error over the surface to `report`. Puts `baked` in the order of the shipped file.
/// Throws `Error` if path tracing cannot provide a reference.
void add_budget(BudgetRequest request, SceneFile& baked, Report& report, const Host& host);

} // namespace prt::pipeline
