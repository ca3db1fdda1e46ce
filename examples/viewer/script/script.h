#pragma once

#include <filesystem>
#include <vector>

namespace viewer {

/// Opens `files` and carries out the steps of the JSON file `script` without a window: an array of objects
/// with one member each, which docs/viewer.md lists. Files are relative to the script. Throws `prt::Error`
/// for a script that is wrong, and where a message for the user comes up that no step {"expect_message":
/// "part of it"} waits for.
void run_script(const std::filesystem::path& script, const std::vector<std::filesystem::path>& files);

} // namespace viewer
