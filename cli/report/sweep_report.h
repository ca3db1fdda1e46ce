#pragma once

#include "cli/report/report.h"
#include "compress/study/sweep.h"

namespace prt::pipeline {

/// Two charts with the best of every method at each size, for people, and all points, for files.
void add_sweep(const Sweep& sweep, Report& report);

} // namespace prt::pipeline
