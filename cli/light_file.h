#pragma once

// The light files of docs/format.md.

#include "prt/light.h"
#include "report/report.h"

#include <filesystem>

namespace prt::cli {

Json light_json(const Light& light);

/// Reads a light file: its coefficients with its suns added. Throws `Error` that names it.
Light read_light_json(const std::filesystem::path& path);

} // namespace prt::cli
