#pragma once

#include "cli/pipeline/instance_sharing.h"
#include "cli/report/report.h"
#include "prt/bake/refine.h"
#include "prt/core/instances.h"

#include <cstdint>
#include <optional>
#include <string>

namespace prt::pipeline {

/// Result of a bake whose instances share transfer.
struct InstanceOutcome {
    std::string output;
    const Scene& scene; ///< unique
    const InstancedBake& baked;
    double error = 0;                                ///< allowed error of an instance
    std::optional<RefineStatistics> refinement = {}; ///< empty: the mesh is not refined
    double refine_target = 0;
    std::uintmax_t bytes = 0; ///< file size
};

Report instance_report(const InstanceOutcome& outcome);

/// Adds `figures` of instances of compressed transfer, and the size of their constants.
void add_instance_constants(const std::vector<RelitInstance>& instances, Json figures, Report& report);

/// Returns {"median", "percentile_90", "percentile_99", "max"} of errors, which must not be empty.
Json percentiles(std::vector<double> errors);

} // namespace prt::pipeline
