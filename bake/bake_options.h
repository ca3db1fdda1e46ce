#pragma once

#include "prt/bake.h"

namespace prt {

/// Throws `Error` for options outside their range, and for those that do not go together.
void check_options(const BakeOptions& options);

} // namespace prt
