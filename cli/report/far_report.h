#pragma once

#include "prt/far_blockers.h"
#include "report/report.h"

#include <optional>

namespace prt::cli {

/// Tells of voxels that stood in for meshes far away, where any did.
void add_far_blockers(const std::optional<FarBlockerFigures>& figures, Report& report);

} // namespace prt::cli
