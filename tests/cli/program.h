#pragma once

#include <string>
#include <vector>

namespace prt::test {

struct Outcome {
    int status = 0; ///< exit status; 128 + signal when killed
    std::string out, err;
};

/// Runs prt with these arguments.
Outcome prt(const std::vector<std::string>& arguments);

/// Runs another program.
Outcome run(const std::string& program, const std::vector<std::string>& arguments);

} // namespace prt::test
