#pragma once

#include "core/viewer.h"

namespace viewer {

/// Shows the sources of the error over the surface: a bar of their shares, and their values.
void budget_panel(Viewer& viewer);

} // namespace viewer
