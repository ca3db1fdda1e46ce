#pragma once

#include "pictures/lamps.h"

#include <nlohmann/json_fwd.hpp>

namespace viewer {

/// Sets what `json` names, {"NAME": strength or [red, green, blue], "*": of all others}, as a file of
/// `prt render --lamps` does; those that it does not name stay as they are. Throws `prt::Error` for a name
/// that no lamp has, and for strengths outside 0..kMostLampStrength.
void set_strengths(std::vector<Lamp>& lamps, const nlohmann::json& json);

} // namespace viewer
