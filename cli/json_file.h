#pragma once

// Files of JSON, with errors in our words.

#include "report/report.h"

#include <filesystem>

namespace prt::cli {

/// Throws `Error` for what is no JSON; it does not name the file.
Json read_json(const std::filesystem::path& path);

} // namespace prt::cli
