#pragma once

// Validation of BakeOptions.

#include "prt/bake/bake_options.h"

namespace prt {

/// Throws `Error` for options outside their range, and for options that cannot be combined.
void check_options(const BakeOptions& options);

} // namespace prt
