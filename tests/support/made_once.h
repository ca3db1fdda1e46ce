#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace prt::test {

/// Writes the file `to`. The first call with `key` in this process makes it by `make`, which gets the path to
/// write; later calls copy it. Tests of one suite share a process (tests/prt_tests.cmake), so common files
/// are made once. Returns `to`.
std::filesystem::path made_once(const std::string& key, const std::filesystem::path& to,
                                const std::function<void(const std::filesystem::path&)>& make);

} // namespace prt::test
