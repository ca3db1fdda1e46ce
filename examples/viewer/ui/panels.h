#pragma once

#include "core/viewer.h"

namespace viewer {

/// Everything of Dear ImGui in a frame: call between its NewFrame and Render.
void draw_panels(Viewer& viewer);
/// Closes the drop-down that is open, else messages, else the help. Between ImGui::NewFrame and Render.
void close_topmost(Viewer& viewer);

} // namespace viewer
