#pragma once

#include "core/moving.h"

#include <nlohmann/json_fwd.hpp>

namespace viewer {

/// What a script says of the figure: {"animation": name, "scale": factor, "path": [[x, y, z], ...]}, all of
/// which may be left out. Throws `prt::Error` for a scale that is none, and for places that are not finite.
FigureChoice figure_choice(const nlohmann::json& json);

} // namespace viewer
