#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace prt::cli {

/// A file that a command is about to write.
struct Output {
    std::filesystem::path path; ///< empty: not requested
    std::string option;         ///< "--json"
    /// Allowed suffixes of its name; empty: any suffix that does not belong to another kind of file.
    std::vector<std::string_view> suffixes = {};
    bool suffix_needed = false; ///< the reader requires a suffix; otherwise a name without one is valid, too
};

/// Checks before work begins that all outputs can be written: the folder exists and is writable, names have
/// allowed suffixes, no output is an input (a run never changes its inputs), and no two outputs are equal.
/// Returns the requested outputs, which readers of scenes reject as parts of them (`GltfOptions::outputs`).
/// Throws `Error`.
std::vector<std::filesystem::path> check_outputs(const std::vector<Output>& outputs,
                                                 const std::vector<std::filesystem::path>& inputs);

} // namespace prt::cli
