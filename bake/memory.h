#pragma once

// Whether a bake fits into memory.

#include "plan.h"

namespace prt {

/// Throws `Error` where what `plan` needs and `more` bytes, as of the operator of its bounces, do not fit.
void check_memory(const BakePlan& plan, double more = 0);

/// Whether they fit, when the machine tells how much there is.
bool fits_memory(const BakePlan& plan, double more);

} // namespace prt
