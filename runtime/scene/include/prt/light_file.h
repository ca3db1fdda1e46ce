#pragma once

// Light files, as `prt project` writes them (docs/format.md). Stable.

#include "prt/light.h"
#include "prt/sun.h"

#include <filesystem>
#include <vector>

namespace prt {

/// Content of a light file.
struct LightFile {
    Light sky; ///< light without `suns`
    std::vector<Sun> suns;
};

/// Reads a light file. Throws `Error` with the file name.
LightFile read_light_file(const std::filesystem::path& path);
/// Reads a light file and keeps the first `order` bands. Throws `Error` with the file name, also if the file
/// has fewer bands.
LightFile read_light_file(const std::filesystem::path& path, int order);

/// Returns the coefficients of the sky plus those of the suns.
Light all_light(const LightFile& file);

} // namespace prt
