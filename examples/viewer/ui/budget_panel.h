#pragma once

#include "core/viewer.h"

namespace viewer {

/// Where the error over the surface comes from: a bar of the causes' shares, and their numbers.
void budget_panel(Viewer& viewer);

} // namespace viewer
