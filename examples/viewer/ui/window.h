#pragma once

#include <filesystem>
#include <vector>

namespace viewer {

/// Opens a window and returns after it is closed. Throws `prt::Error` without a display or OpenGL 4.5.
void run_window(const std::vector<std::filesystem::path>& files, int width, int height);

} // namespace viewer
