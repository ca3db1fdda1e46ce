#pragma once

#include "prt/sweep.h"
#include "report.h"

#include <string>

namespace prt::cli {

/// Two charts, equal bytes and equal shader operations, and their tables.
std::string sweep_html(const Sweep& sweep);
Json sweep_json(const Sweep& sweep);
/// The best of every method at each size, as lines of text.
void print_sweep(const Sweep& sweep);

} // namespace prt::cli
