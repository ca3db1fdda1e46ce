#pragma once

#include "pictures/lamps.h"

#include <nlohmann/json_fwd.hpp>

namespace viewer {

/// Sets the lamps named in `json`, {"NAME": strength or [red, green, blue], "*": strength of all others}, as
/// a file of `prt render --lamp-strengths` does; other lamps stay unchanged. Throws `prt::Error` for a name
/// that no lamp has, and for strengths outside 0..kMaxLampStrength.
void set_strengths(std::vector<LampControl>& lamps, const nlohmann::json& json);

} // namespace viewer
