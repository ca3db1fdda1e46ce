#pragma once

// What a bake takes in memory, and what it loses when stored in fewer bits.

#include "prt/bake.h"

namespace prt {

/// Relative L2 error of `transfer` rounded to float16.
double half_rounding_error(const Transfer& transfer, std::span<const float> areas);

/// Bytes of this machine's memory; 0 where the system does not say.
double physical_memory();

} // namespace prt
