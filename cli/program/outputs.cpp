// Checks the output files of a command.

#include "cli/program/outputs.h"

#include "cli/pipeline/model.h"
#include "prt/core/error.h"
#include "runtime/core/support/file.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace prt::cli {

using pipeline::Path;

namespace {

/// Suffixes that indicate the content of a file.
constexpr std::array<std::string_view, 15> kTelling = {".glb",  ".gltf", ".bin", ".png", ".jpg",
                                                       ".jpeg", ".exr",  ".hdr", ".csv", ".json",
                                                       ".html", ".htm",  ".obj", ".fbx", ".ply"};

/// Whether both names lead to one file, there or not.
bool same_file(const Path& a, const Path& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error))
        return true;
    return std::filesystem::weakly_canonical(followed(a), error) ==
           std::filesystem::weakly_canonical(followed(b), error);
}

/// A stream, as /dev/null is, needs no suffix where there is no choice of formats.
void check_suffix(const Output& output, bool stream) {
    const bool needed = output.suffix_needed && (!stream || output.suffixes.size() > 1);
    const std::string suffix = suffix_of(output.path);
    const auto is_in = [&](const auto& list) {
        return std::find(list.begin(), list.end(), suffix) != list.end();
    };
    if (suffix.empty() ? !needed : output.suffixes.empty() ? !is_in(kTelling) : is_in(output.suffixes))
        return;
    if (output.suffixes.empty())
        throw Error(fmt::format("{}: {} writes text; the name of the file must not end in {}",
                                output.path.string(), output.option, suffix));
    throw Error(fmt::format("{}: the name of the file must end in {}; {} writes no other format",
                            output.path.string(), fmt::join(output.suffixes, " or "), output.option));
}

/// Returns the files that a name stands for: six if it contains {face}.
std::vector<Path> files_of(const Path& input) {
    constexpr std::string_view kMark = "{face}";
    const std::string name = input.string();
    const std::size_t at = name.find(kMark);
    if (at == std::string::npos)
        return {input};
    std::vector<Path> files;
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"})
        files.emplace_back(std::string(name).replace(at, kMark.size(), face));
    return files;
}

} // namespace

std::vector<Path> check_outputs(const std::vector<Output>& outputs, const std::vector<Path>& inputs) {
    std::vector<Output> asked;
    std::copy_if(outputs.begin(), outputs.end(), std::back_inserter(asked),
                 [](const Output& output) { return !output.path.empty(); });
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const Output& output = asked[i];
        const std::string name = output.path.string();
        const OutputFile opened(output.path); // leaves no file behind
        check_suffix(output, opened.is_stream());
        for (const Path& input : inputs)
            for (const Path& file : files_of(input))
                if (!file.empty() && same_file(file, output.path))
                    throw Error(fmt::format("{}: is an input, which {} would overwrite; use another name",
                                            name, output.option));
        for (std::size_t other = 0; other < i; ++other)
            if (same_file(asked[other].path, output.path))
                throw Error(fmt::format("{}: {} and {} would be one file; use another name", name,
                                        asked[other].option, output.option));
    }
    std::vector<Path> paths;
    for (const Output& output : asked)
        paths.push_back(output.path);
    return paths;
}

} // namespace prt::cli
