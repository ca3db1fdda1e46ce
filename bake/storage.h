#pragma once

// What a bake loses when stored in fewer bits.

#include "prt/bake.h"

namespace prt {

/// Relative L2 error of `transfer` rounded to float16.
double half_rounding_error(const Transfer& transfer, std::span<const float> areas);

} // namespace prt
