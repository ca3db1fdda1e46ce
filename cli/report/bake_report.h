#pragma once

#include "prt/bake.h"
#include "prt/refine.h"
#include "report/report.h"

#include <cstdint>
#include <optional>
#include <string>

namespace prt::cli {

/// What a bake was asked for, and what came of it.
struct BakeOutcome {
    std::string output;
    const BakeOptions& options;
    bool no_shadow = false; ///< surfaces of some materials were left out
    const Scene& scene;     ///< as it was baked
    const BakeResult& result;
    std::optional<RefineStatistics> refinement; ///< none: the mesh is the file's
    double refine_target = 0;
    std::uintmax_t bytes = 0; ///< of the file
};

Report bake_report(const BakeOutcome& baked);

} // namespace prt::cli
