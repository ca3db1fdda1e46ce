#pragma once

#include "cli/report/report.h"

namespace prt::pipeline {

/// Renames figures and sentences of a report whose receivers are texels: "per vertex" becomes "per texel",
/// also in keys.
void report_texels(Report& report);

} // namespace prt::pipeline
