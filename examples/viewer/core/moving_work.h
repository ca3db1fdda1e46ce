#pragma once

// Background jobs for moving objects.

#include "core/findings.h"

namespace viewer {

/// Reads all files and sorts them. Throws `prt::Error`.
SortedFiles sort_files(const std::vector<std::filesystem::path>& paths, bool scene_open);

/// Reads a figure, then its occluders, which are measured if the file has none. Posts each. Throws
/// `prt::Error`.
void find_figure(Channel& channel, const std::filesystem::path& path);

/// Reads the volume of the model's file and compresses it if needed; otherwise bakes one, first with few rays
/// and then with more. Posts each.
void find_volume(Channel& channel, const std::shared_ptr<const Model>& model);

} // namespace viewer
