#pragma once

#include <filesystem>
#include <vector>

namespace viewer {

/// Opens `files` and carries out the steps of the JSON file `script` without a window: an array of objects
/// with one member each,
///     {"size": [width, height]}, {"open": "file" or [files]}, {"wait": "work"}, {"wait": {"reference":
///     passes}},
///     {"set": {settings}}, {"camera": {"position": [x, y, z], "target": [x, y, z]}}, {"day": {"hour": 10}},
///     {"rotate": degrees}, {"light": {"kind": "sun", "direction": [x, y, z], ...}}, {"compress": {"order":
///     6, ...}},
///     {"press": ["left", x, y]}, {"move": [x, y]}, {"release": []}, {"scroll": notches}, {"keys": "DW"},
///     {"hover": [x, y]}, {"draw": frames}, {"spin": frames},
///     {"lose_context": []}, {"screenshot": "file.png"}, {"figures":
///     "file.json"}.
/// Files are relative to the script. Throws `prt::Error` for a script that is wrong, and where a message for
/// the user comes up that no step {"expect_message": "part of it"} waits for.
void run_script(const std::filesystem::path& script, const std::vector<std::filesystem::path>& files);

} // namespace viewer
