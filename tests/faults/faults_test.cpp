// Makes every system call of a program fail once: the pipeline of a small scene, with the library of
// fault_injector.c. No partial file may be left, no input lost, and the error is one line.

#include "cli/program.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace prt::test {
namespace {

/// One command, in a separate folder with its inputs.
struct Command {
    std::vector<std::string> words;
    std::vector<std::string> inputs, outputs; ///< names in the folder
};

using Files = std::map<std::string, std::string>;

Files files_of(const std::filesystem::path& folder) {
    Files files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::string& text = files[entry.path().filename().string()];
        if (entry.file_size() > 0)
            for (const std::byte b : read_file(entry.path()))
                text += std::to_integer<char>(b);
    }
    return files;
}

/// Number of faults per kind, evenly distributed; 0: all (PRT_FAULTS, for a manual run).
long faults_of_a_kind() {
    const char* given = std::getenv("PRT_FAULTS");
    return given ? std::atol(given) : 3;
}

class Faults : public testing::Test {
protected:
    Faults() {
        triangle_file().write(pipeline / "scene.glb");
        pipeline.file("light.json", R"({"prtkit_light": 1, "order": 2, "coefficients": {"red": [1, 0, 0, 0],
                                    "green": [1, 0, 0, 0], "blue": [1, 0, 0, 0]}})");
        for (const Command& command : commands()) {
            const Outcome outcome = run_in(pipeline, command, {});
            EXPECT_EQ(outcome.status, 0) << outcome.err;
        }
        complete = files_of(pipeline.path());
    }

    static std::vector<Command> commands() {
        return {{{"bake", "scene.glb", "-o", "baked.glb", "--order", "2", "--rays", "4", "--bounces", "1",
                  "--device", "cpu", "--json", "bake.json"},
                 {"scene.glb"},
                 {"baked.glb", "bake.json"}},
                {{"compress", "baked.glb", "-o", "shipped.glb", "--trace", "trace.jsonl"},
                 {"baked.glb"},
                 {"shipped.glb", "trace.jsonl"}},
                {{"evaluate", "baked.glb", "shipped.glb", "--report", "page.html", "--json", "evaluate.json"},
                 {"baked.glb", "shipped.glb"},
                 {"page.html", "evaluate.json"}},
                {{"render", "shipped.glb", "--lights", "light.json", "-o", "picture.exr", "--size", "16x8",
                  "--device", "cpu", "--json", "render.json"},
                 {"shipped.glb", "light.json"},
                 {"picture.exr", "render.json"}}};
    }

    static Outcome run_in(const TemporaryFolder& folder, const Command& command,
                          const std::vector<std::string>& variables) {
        std::vector<std::string> words = {"-C", folder.path().string(), "LD_PRELOAD=" PRT_FAULT_INJECTOR};
        words.insert(words.end(), variables.begin(), variables.end());
        words.emplace_back(PRT_PROGRAM);
        words.insert(words.end(), command.words.begin(), command.words.end());
        return run("env", words);
    }

    /// Fills a folder with the inputs of `command`, and with old files at its outputs if `old`.
    void prepare(const TemporaryFolder& folder, const Command& command, bool old) const {
        for (const std::string& input : command.inputs)
            folder.file(input, complete.at(input));
        for (const std::string& output : command.outputs)
            if (old)
                folder.file(output, "old");
    }

    /// Checks that all outputs are complete, or all are unchanged.
    void expect_complete(const TemporaryFolder& folder, const Command& command, bool old,
                         bool written) const {
        const Files files = files_of(folder.path());
        for (const std::string& input : command.inputs)
            EXPECT_TRUE(files.at(input) == complete.at(input)) << input;
        for (const std::string& output : command.outputs) {
            const auto found = files.find(output);
            if (!written) {
                EXPECT_EQ(found == files.end() ? "" : found->second, old ? "old" : "") << output;
            } else if (found == files.end()) {
                ADD_FAILURE() << output << " is missing";
            } else if (output.ends_with(".glb") || output.ends_with(".exr")) {
                EXPECT_TRUE(found->second == complete.at(output)) << output;
            } else { // contains the duration
                EXPECT_TRUE(found->second.ends_with(output.ends_with(".html") ? ">\n" : "}\n")) << output;
            }
        }
        EXPECT_LE(files.size(), command.inputs.size() + command.outputs.size());
    }

    void fail_once(const Command& command, const std::string& fault, const std::string& without, bool old) {
        SCOPED_TRACE(command.words[0] + " " + fault + " " + without + (old ? " old" : ""));
        const TemporaryFolder folder;
        prepare(folder, command, old);
        const Outcome outcome =
            run_in(folder, command, {"PRT_FAULT=" + fault, "PRT_FAULT_WITHOUT=" + without});
        EXPECT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.status << outcome.err;
        if (outcome.status == 1) {
            const std::size_t at = outcome.err.find("prt: error: ");
            ASSERT_NE(at, std::string::npos) << outcome.err;
            EXPECT_EQ(std::count(outcome.err.begin() + static_cast<long>(at), outcome.err.end(), '\n'), 1)
                << outcome.err;
            EXPECT_EQ(outcome.err.find("internal error"), std::string::npos) << outcome.err;
        }
        expect_complete(folder, command, old, outcome.status == 0);
    }

    void kill_once(const Command& command, const std::string& fault, const std::string& without, bool old) {
        SCOPED_TRACE(command.words[0] + " " + fault + " " + without + (old ? " old" : ""));
        const TemporaryFolder folder;
        prepare(folder, command, old);
        const Outcome killed =
            run_in(folder, command, {"PRT_FAULT=" + fault + ":kill", "PRT_FAULT_WITHOUT=" + without});
        EXPECT_TRUE(killed.status == 128 + 9 || killed.status == 0); // fewer calls without an old file
        const Files files = files_of(folder.path());
        for (const std::string& output : command.outputs)
            if (output.ends_with(".glb") && files.contains(output) && files.at(output) != "old") {
                EXPECT_TRUE(files.at(output) == complete.at(output)) << output;
            }
        const Outcome after = run_in(folder, command, {});
        EXPECT_EQ(after.status, 0) << after.err;
        expect_complete(folder, command, old, true); // and no other file remains
    }

    /// Returns the number of calls of each kind that a command makes.
    std::map<std::string, long> counts_of(const Command& command, const std::string& without) const {
        const TemporaryFolder folder, notes;
        prepare(folder, command, true);
        const std::string counts = (notes / "counts").string();
        run_in(folder, command, {"PRT_FAULT_COUNTS=" + counts, "PRT_FAULT_WITHOUT=" + without});
        std::map<std::string, long> result;
        std::istringstream lines(files_of(notes.path()).at("counts"));
        std::string kind;
        for (long count = 0; lines >> kind >> count;)
            result[kind] = count;
        return result;
    }

    /// Calls `one` for faults of these kinds, spread over the command, with and without old files.
    void spread(const std::vector<std::string>& kinds, const std::string& without, const auto& one) {
        for (const Command& command : commands()) {
            const auto counts = counts_of(command, without);
            for (const std::string& kind : kinds) {
                const long all = counts.at(kind), most = faults_of_a_kind();
                const long tried = most == 0 ? all : std::min(all, most);
                for (long i = 0; i < tried; ++i) // the last calls publish the files
                    one(command, kind + ":" + std::to_string(all - i * all / tried), without, i % 2 == 0);
            }
        }
    }

    TemporaryFolder pipeline;
    Files complete; ///< files of a run without faults
};

TEST_F(Faults, NoDataIsLostAfterASingleFailure) {
    const auto fail = [this](const auto&... about) { fail_once(about...); };
    spread({"write", "open", "rename", "sync", "map", "allocate", "thread"}, "", fail);
}

TEST_F(Faults, NoDataIsLostWithoutUnnamedFiles) {
    const auto fail = [this](const auto&... about) { fail_once(about...); };
    spread({"write", "open", "rename", "sync"}, "tmpfile", fail);
    spread({"rename"}, "tmpfile,exchange",
           [&](const Command& command, const std::string& fault, const std::string& without, bool) {
               if (command.outputs.size() == 1) // with two outputs, old files cannot be restored
                   fail_once(command, fault, without, true);
           });
}

TEST_F(Faults, KilledRunsLeaveCompleteFilesAndTheNextCleansUp) {
    const auto kill = [this](const auto&... about) { kill_once(about...); };
    spread({"write", "open", "rename", "sync"}, "", kill);
    spread({"write", "rename", "sync"}, "tmpfile", kill);
}

/// OpenEXR omits lines without an error if it has no memory to compress them.
TEST_F(Faults, PicturesAreCompleteOrMissing) {
    const Command render = commands().back();
    const long all = counts_of(render, "").at("allocate");
    for (long n = std::max(1L, all - 200); n <= all; ++n)
        fail_once(render, "allocate:" + std::to_string(n), "", true);
}

/// Embree builds its trees in threads of its library, and reports an error if it gets none.
TEST_F(Faults, OneThreadSufficesOrIsReportedInOneLine) {
    for (const Command& command : commands()) {
        fail_once(command, "thread:1:all", "", false);
        if (command.words[0] == "compress") {
            const TemporaryFolder folder;
            prepare(folder, command, false);
            EXPECT_EQ(run_in(folder, command, {"PRT_FAULT=thread:1:all"}).status, 0);
        }
    }
}

TEST_F(Faults, MissingMemoryAndDescriptorsAreReportedInOneLine) {
    for (const Command& command : commands())
        for (const char* kind : {"allocate", "open", "write"})
            for (const char* from : {"1", "2", "20", "200"})
                fail_once(command, std::string(kind) + ":" + from + ":all", "", true);
}

} // namespace
} // namespace prt::test
