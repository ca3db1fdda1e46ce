#pragma once

// The light files of docs/format.md.

#include "prt/sun_disc.h"
#include "report/report.h"

#include <filesystem>
#include <vector>

namespace prt::cli {

Json light_json(const Light& light);

/// What a light file holds.
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

} // namespace prt::cli
