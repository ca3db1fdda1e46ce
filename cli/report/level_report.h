#pragma once

#include "level_arguments.h"
#include "report/report.h"

namespace prt::cli {

/// What a bake made of coarser levels.
void add_level_bake(const BakedLevels& levels, Report& report);

} // namespace prt::cli
