#pragma once

#include "cli/pipeline/model_levels.h"
#include "cli/report/report.h"

namespace prt::pipeline {

/// Adds the bake of coarser levels to a report.
void add_level_bake(const BakedLevels& levels, Report& report);

} // namespace prt::pipeline
