#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prt::test {

struct Outcome {
    int status = 0; ///< exit status; 128 + signal when killed
    std::string out, err;
};

/// Runs prt with these arguments.
Outcome prt(const std::vector<std::string>& arguments);

/// Runs `prt ARGUMENTS... -o to`, once in this process for an equal `key`; later calls copy the file. Throws
/// if prt fails.
void prt_once(const std::string& key, const std::vector<std::string>& arguments,
              const std::filesystem::path& to);

/// Returns a model or sky that ctest makes once for all tests (tests/fixtures): `knot.baked.glb`.
std::filesystem::path fixture(const std::string& name);

/// Copies example scenes (NAME.glb) and skies (NAME.exr) of the fixtures into `folder`.
void copy_examples(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Runs a different program.
Outcome run(const std::string& program, const std::vector<std::string>& arguments);

} // namespace prt::test
