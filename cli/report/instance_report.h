#pragma once

#include "instance_arguments.h"
#include "prt/instance_former.h"
#include "report/report.h"

#include <cstdint>
#include <string>

namespace prt::cli {

/// A bake whose instances share transfer, and what came of it.
struct InstanceOutcome {
    std::string output;
    const Scene& scene; ///< flat
    const InstancedBake& baked;
    double error = 0;         ///< that instances may have
    std::uintmax_t bytes = 0; ///< of the file
};

Report instance_report(const InstanceOutcome& outcome);

/// Adds `figures` of instances of compressed transfer, and what their constants take.
void add_instance_constants(const std::vector<FormedInstance>& instances, Json figures, Report& report);

/// {"median", "percentile_90", "percentile_99", "most"} of errors, of which there are some.
Json percentiles(std::vector<double> errors);

} // namespace prt::cli
