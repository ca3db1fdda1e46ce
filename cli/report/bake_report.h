#pragma once

#include "cli/report/report.h"
#include "prt/bake/bake.h"
#include "prt/bake/refine.h"

#include <cstdint>
#include <optional>
#include <string>

namespace prt::pipeline {

/// Options and result of a bake.
struct BakeOutcome {
    std::string output;
    const BakeOptions& options;
    bool no_shadow = false; ///< surfaces of some materials cast no shadow
    const Scene& scene;     ///< the baked scene
    const BakeResult& result;
    std::optional<RefineStatistics> refinement; ///< empty: the mesh is not refined
    double refine_target = 0;
    std::uintmax_t bytes = 0; ///< file size
};

Report bake_report(const BakeOutcome& baked);

/// Adds the figures of a refinement, and sentences about them.
void add_refinement(const RefineStatistics& refinement, double target, Report& report);

} // namespace prt::pipeline
