#pragma once

#include "viewer.h"

namespace viewer {

/// Everything of Dear ImGui in a frame: call between its NewFrame and Render.
void draw_panels(Viewer& viewer);

} // namespace viewer
