#pragma once

// The budget of errors of files.

#include "budget/budget_lights.h"
#include "inputs.h"
#include "reading_options.h"
#include "report/report.h"
#include "session.h"

namespace prt::cli {

/// Files whose errors are measured against path tracing.
struct BudgetRequest {
    Path baked, shipped;    ///< shipped: empty where there is none
    ReadingOptions reading; ///< of `shipped`
    BudgetLightOptions lights;
    std::vector<std::string> no_shadow; ///< materials that the bake let light through
};

/// Adds what errors over the surface come from to `report`. `baked` is in the order of the shipped file.
/// Throws `Error` for what path tracing cannot be a reference for.
void add_budget(BudgetRequest request, SceneFile& baked, Report& report, Session& session);

} // namespace prt::cli
