#pragma once

// Light files of prt project: docs/format.md. Stable.

#include "prt/light.h"
#include "prt/sun.h"

#include <filesystem>
#include <vector>

namespace prt {

/// Content of a light file.
struct LightFile {
    Light sky; ///< its coefficients
    std::vector<Sun> suns;
};

/// Reads a light file. Throws `Error` with the file name.
LightFile read_light_file(const std::filesystem::path& path);
/// Reads the first `order` bands. Also throws `Error` if the file has fewer.
LightFile read_light_file(const std::filesystem::path& path, int order);

/// Returns the coefficients of the sky plus those of the suns.
Light all_light(const LightFile& file);

} // namespace prt
