#pragma once

#include "core/moving.h"

#include <nlohmann/json_fwd.hpp>

namespace viewer {

/// Parses the figure options of a script: {"animation": name, "scale": factor, "path": [[x, y, z], ...]};
/// each may be omitted. Throws `prt::Error` for an invalid scale and for positions that are not finite.
FigureChoice figure_choice(const nlohmann::json& json);

} // namespace viewer
