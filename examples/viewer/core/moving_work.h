#pragma once

// What the viewer finds in the background for what moves.

#include "core/findings.h"

namespace viewer {

/// Reads all of them. Throws `prt::Error`.
SortedFiles sort_files(const std::vector<std::filesystem::path>& paths, bool scene_open);

/// Reads a figure, then what it blocks around it, measured where the file does not say it. Posts each. Throws
/// `prt::Error`.
void find_figure(Channel& channel, const std::filesystem::path& path);

/// The volume that a file holds, compressed where it is not; else one baked with few rays and then with more.
/// Posts each.
void find_volume(Channel& channel, const std::shared_ptr<const Model>& model);

} // namespace viewer
