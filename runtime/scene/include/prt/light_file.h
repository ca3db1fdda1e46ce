#pragma once

// Light files of prt project: docs/format.md. Stable.

#include "prt/light.h"
#include "prt/sun_disc.h"

#include <filesystem>
#include <vector>

namespace prt {

/// Contents of a light file.
struct LightFile {
    Light sky; ///< its coefficients
    std::vector<SunDisc> suns;
};

/// Throws `Error` that names the file.
LightFile read_light_file(const std::filesystem::path& path);
/// Its first `order` bands. Throws `Error`, too, where it has fewer.
LightFile read_light_file(const std::filesystem::path& path, int order);

/// Its coefficients with its suns added.
Light all_light(const LightFile& file);

} // namespace prt
