#pragma once

#include "level_arguments.h"
#include "report/report.h"

namespace prt::cli {

/// Adds the bake of coarser levels to a report.
void add_level_bake(const BakedLevels& levels, Report& report);

} // namespace prt::cli
