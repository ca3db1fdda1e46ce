#pragma once

#include <filesystem>
#include <vector>

namespace viewer {

/// Opens `files` and executes the steps of the JSON file `script` without a window: an array of objects with
/// one member each, listed in docs/viewer.md. Files are relative to the script. Throws `prt::Error` for an
/// invalid script, and for a message to the user that no step {"expect_message": "part of it"} expects.
void run_script(const std::filesystem::path& script, const std::vector<std::filesystem::path>& files);

} // namespace viewer
