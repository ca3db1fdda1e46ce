#pragma once

#include "measure.h"

#include <filesystem>

namespace comparison {

/// Returns Markdown with tables and pictures. `images` is the folder of the pictures, as the page refers to
/// it. `note` is the last line.
std::string report(const std::vector<SceneResult>& scenes, const std::vector<Sky>& skies,
                   const Options& options, const std::string& images, const std::string& note);

/// For each scene a PNG into `folder`: reference and methods side by side, and below each its error as heat.
void write_pictures(const std::vector<SceneResult>& scenes, const Options& options,
                    const std::filesystem::path& folder);

} // namespace comparison
