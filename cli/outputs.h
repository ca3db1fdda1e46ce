#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace prt::cli {

/// A file that a command is about to write.
struct Output {
    std::filesystem::path path; ///< empty: not asked for
    std::string option;         ///< "--json"
    /// What its name may end in; empty: in anything that does not stand for another kind of file.
    std::vector<std::string_view> suffixes = {};
    bool suffix_needed = false; ///< by whoever reads it; else a name without any will do
};

/// Asks before work begins whether all outputs can be written: there is such a folder and one may write
/// there, names end in what is written, none is an input (a run never touches those) and no two are one.
/// Returns those that are asked for, which readers of scenes refuse as parts of them
/// (`GltfOptions::outputs`). Throws `Error`.
std::vector<std::filesystem::path> check_outputs(const std::vector<Output>& outputs,
                                                 const std::vector<std::filesystem::path>& inputs);

/// Lower-case, with the dot.
std::string suffix_of(const std::filesystem::path& path);

} // namespace prt::cli
