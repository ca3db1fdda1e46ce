#pragma once

// Draws over the pictures without a panel: names of the sides, legends, handles of lights.

#include "core/viewer.h"

namespace viewer {

void draw_overlay(const Viewer& viewer);

/// Converts `pixels` of a 96 dpi display to units of the interface.
float scaled(float pixels);

} // namespace viewer
