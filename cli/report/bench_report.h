#pragma once

#include "prt/bench.h"
#include "prt/classic_meshes.h"
#include "report/report.h"

#include <span>

namespace prt::cli {

/// All runs, with the curves of error over time and of speed over rays.
Report bench_report(const BenchResult& result);

/// The table of Hill's article, with what was measured beside it: a result for each row.
Report classic_report(std::span<const ClassicRow> rows, std::span<const BenchResult> results);

} // namespace prt::cli
