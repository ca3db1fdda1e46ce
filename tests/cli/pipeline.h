#pragma once

// A folder for the tests of the whole pipeline, and readers of its files.

#include "program.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>

namespace prt::test {

inline nlohmann::json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

/// Returns the number of errors of Khronos' validator, or -1 if it cannot be run.
inline int validator_errors(const std::filesystem::path& file) {
    if (std::string(PRT_NODE).empty() || !std::filesystem::exists(PRT_VALIDATOR_MODULES))
        return -1;
    const Outcome outcome = run(PRT_NODE, {PRT_VALIDATE, PRT_VALIDATOR_MODULES, file.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    return outcome.status;
}

class Pipeline : public testing::Test {
protected:
    std::string at(const char* name) const { return (folder / name).string(); }
    TemporaryFolder folder;
};

} // namespace prt::test
