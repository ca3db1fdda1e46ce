#pragma once

// What is drawn over the pictures without a panel: names of the sides, legends, handles of lights.

#include "core/viewer.h"

namespace viewer {

void draw_overlay(const Viewer& viewer);

/// `pixels` of a display of 96 dots an inch, in units of the interface.
float scaled(float pixels);

} // namespace viewer
