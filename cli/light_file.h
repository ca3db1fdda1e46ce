#pragma once

// The light files of docs/format.md.

#include "prt/sun_disc.h"
#include "report/report.h"

#include <filesystem>
#include <vector>

namespace prt::cli {

Json light_json(const Light& light);

/// Content of a light file.
struct LightFile {
    Light sky; ///< its coefficients
    std::vector<SunDisc> suns;
};

/// Reads a light file. Throws `Error` with the file name.
LightFile read_light_file(const std::filesystem::path& path);
/// Reads the first `order` bands. Also throws `Error` if the file has fewer.
LightFile read_light_file(const std::filesystem::path& path, int order);

/// Returns the coefficients of the sky plus those of the suns.
Light all_light(const LightFile& file);

} // namespace prt::cli
