#pragma once

#include "bake/studies/bench.h"
#include "cli/report/report.h"

namespace prt::pipeline {

/// All runs, with the curves of error over time and of speed over rays.
Report bench_report(const BenchResult& result);

} // namespace prt::pipeline
