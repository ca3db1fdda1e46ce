#pragma once

#include "core/viewer.h"

namespace viewer {

/// Draws all of Dear ImGui in a frame; call it between NewFrame and Render.
void draw_panels(Viewer& viewer);
/// Closes the open drop-down, otherwise messages, otherwise the help. Call it between ImGui::NewFrame and
/// Render.
void close_topmost(Viewer& viewer);

} // namespace viewer
