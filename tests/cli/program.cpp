// Runs programs and captures their output.

#include "program.h"

#include "support/made_once.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <sys/wait.h>

namespace prt::test {
namespace {

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

Outcome run(const std::string& program, const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    std::string command = quoted(program);
    for (const std::string& argument : arguments)
        command += " " + quoted(argument);
    command += " >" + quoted((folder / "out").string()) + " 2>" + quoted((folder / "err").string());
    const int raw = std::system(command.c_str());
    const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
    return {status, contents(folder / "out"), contents(folder / "err")};
}

Outcome prt(const std::vector<std::string>& arguments) {
    const auto uses = [&](const char* word) {
        return std::find(arguments.begin(), arguments.end(), word) != arguments.end();
    };
    if (!uses("gpu") && !uses("--device") && !uses("bench"))
        return run(PRT_PROGRAM, arguments);
    // Leaks of the OpenGL driver cannot be distinguished from ours, as in the test programs that use OpenGL.
    std::vector<std::string> with_environment = {"ASAN_OPTIONS=detect_leaks=0", PRT_PROGRAM};
    with_environment.insert(with_environment.end(), arguments.begin(), arguments.end());
    return run("env", with_environment);
}

void prt_once(const std::string& key, const std::vector<std::string>& arguments,
              const std::filesystem::path& to) {
    made_once(key, to, [&](const std::filesystem::path& path) {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"-o", path.string()});
        const Outcome outcome = prt(all);
        if (outcome.status != 0)
            throw std::runtime_error(outcome.err);
    });
}

std::filesystem::path fixture(const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(PRT_FIXTURES) / name;
    if (!std::filesystem::exists(path))
        throw std::runtime_error(path.string() + " is missing: ctest -R models makes it");
    return path;
}

void copy_examples(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const bool scene = std::filesystem::exists(std::filesystem::path(PRT_FIXTURES) / (name + ".glb"));
        const std::string file = name + (scene ? ".glb" : ".exr");
        std::filesystem::copy_file(fixture(file), folder / file);
    }
}

} // namespace prt::test
