#pragma once

#include "report/report.h"

namespace prt::cli {

/// Figures and sentences of a report whose receivers are texels: "per vertex" becomes "per texel", in keys,
/// too.
void say_texels(Report& report);

} // namespace prt::cli
