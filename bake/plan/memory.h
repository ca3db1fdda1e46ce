#pragma once

// Checks whether a bake fits into memory.

#include "bake/plan/plan.h"

namespace prt {

/// Throws `Error` if the memory of `plan` and `more` bytes, for example of its gather operator, do not fit.
void check_memory(const BakePlan& plan, double more = 0);

/// Whether the memory of `plan` and `more` bytes fit; false if the available memory is unknown.
bool fits_memory(const BakePlan& plan, double more);

} // namespace prt
