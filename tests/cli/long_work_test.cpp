// Tests commands that take minutes: stopped by Ctrl-C, or rejected before they start.

#include "pipeline.h"

#include <chrono>
#include <csignal>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace prt::test {
namespace {

/// A command that takes minutes.
class LongWork : public Pipeline, public testing::WithParamInterface<std::vector<const char*>> {};
INSTANTIATE_TEST_SUITE_P(Phases, LongWork,
                         testing::Values(std::vector<const char*>{"--rays", "1000000"},
                                         std::vector<const char*>{"--rays", "1000000", "--bounces", "1"},
                                         std::vector<const char*>{"--target-error", "0.00001"},
                                         std::vector<const char*>{"--refine", "0.0001"},
                                         std::vector<const char*>{"--rays", "1000000", "--backend", "gpu"},
                                         std::vector<const char*>{"--rays", "1000000", "--backend", "gpu",
                                                                  "--method", "raster"},
                                         std::vector<const char*>{"--rays", "1", "--subsurface",
                                                                  "1,1,1,0,0,0", "--bounces", "inf"}));

/// True if the process has set a handler for SIGINT.
bool minds_interrupts(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:"))
            return std::stoull(line.substr(7), nullptr, 16) & std::uint64_t{1} << (SIGINT - 1);
    return false;
}

TEST_P(LongWork, StopsAtCtrlCWithoutOutput) {
    copy_examples(folder.path(), {"room"});
    const std::size_t before = folder.files();
    const std::string scene = at("room.glb"), output = at("b.glb");
    const pid_t child = fork();
    if (child == 0) {
        std::freopen("/dev/null", "w", stderr);
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1); // a terminated process does not free its memory
        std::vector<const char*> arguments = {PRT_PROGRAM, "bake", scene.c_str(), "-o", output.c_str()};
        arguments.insert(arguments.end(), GetParam().begin(), GetParam().end());
        arguments.push_back(nullptr);
        execv(PRT_PROGRAM, const_cast<char**>(arguments.data()));
        _exit(127);
    }
    for (int waited = 0; waited < 3000 && !minds_interrupts(child);
         ++waited) // a busy machine needs seconds to start
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    kill(child, SIGINT);
    int status = 0;
    for (int waited = 0; waitpid(child, &status, WNOHANG) == 0; ++waited) {
        ASSERT_LT(waited, 500) << "does not end"; // generous: a sanitizer on a busy machine
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    EXPECT_EQ(folder.files(), before);
}
TEST_F(Pipeline, LargeBakesAreRejectedWithTheirSize) {
    copy_examples(folder.path(), {"room"});
    const Outcome bake =
        prt({"bake", at("room.glb"), "-o", at("b.glb"), "--rays", "16777216", "--bounces", "1"});
    EXPECT_EQ(bake.status, 1);
    EXPECT_NE(bake.err.find(" GB of memory"), std::string::npos) << bake.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "b.glb"));
}

} // namespace
} // namespace prt::test
