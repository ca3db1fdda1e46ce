// Tests output and exit of the program: invalid arguments, closed or full streams, invalid file names, text
// with control sequences, killed or cancelled runs.

#include "program.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#ifndef __has_feature // gcc, where this test assumes no sanitizers
#define __has_feature(name) 0
#endif

namespace prt::test {
namespace {

std::string text_in(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Output : public testing::Test {
protected:
    Output() { triangle_file().write(scene); }
    /// `prt` and `words` in a shell, in the folder.
    Outcome shell(const std::string& words) const {
        return run("sh", {"-c", "cd " + folder.path().string() + "; " + words});
    }
    std::string bake(const std::string& more) const {
        return PRT_PROGRAM " bake good.glb -o out.glb --order 2 --rays 4 --device cpu " + more;
    }

    TemporaryFolder folder;
    std::filesystem::path scene = folder / "good.glb";
};

TEST_F(Output, ArgumentsOutOfRangeAreWrongUsage) {
    const std::string file = scene.string(), out = (folder / "out.glb").string(),
                      light = (folder / "out.json").string();
    const std::vector<std::string> bake = {"bake", file, "-o", out}, compress = {"compress", file, "-o", out},
                                   project = {"project", file, "-o", light},
                                   render = {"render", file, "--lights", file, "-o", "p.png"},
                                   bench = {"bench", file};
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> cases = {
        {bake, {"--order", "0", "--order", "11", "--rays", "0", "--rays", "-4", "--rays", "99999999999"}},
        {bake, {"--target-error", "0", "--target-error", "nan", "--target-error", "inf"}},
        {bake, {"--metres-per-unit", "0", "--metres-per-unit", "nan", "--metres-per-unit", "1e300"}},
        {bake, {"--memory-limit", "-1", "--memory-limit", "nan"}},
        {bake, {"--seed", "-1", "--seed", "18446744073709551616", "--seed", "1.5"}},
        {bake, {"--bounces", "2147483647", "--method", "resolution=15", "--json", ""}},
        {bake, {"--subsurface", "1e38,1,1,1,1,1", "--subsurface", "1,1,1,nan,1,1"}},
        {compress, {"--clusters", "0", "--clusters", "65537", "--components", "-1", "--bits", "1000"}},
        {compress, {"--seam-weight", "-1", "--seam-weight", "2e6", "--seam-weight", "nan"}},
        {compress, {"--max-error", "0", "--bytes-per-vertex", "-0.5", "--shader-ops", "inf"}},
        {compress, {"--trace", "", "--lights", "", "--seed", "-1"}},
        {project, {"--order", "11", "--rotate", "nan", "--rotate", "inf", "--json", ""}},
        {render, {"--fov", "nan", "--fov", "0", "--camera", "nan,0,0", "--camera", "inf,0,0"}},
        {render, {"--exposure", "nan", "--exposure", "inf", "--exposure", "1e9", "--samples", "17"}},
        {bench, {"--seconds", "nan", "--seconds", "-1", "--report", ""}}};
    for (const auto& [command, options] : cases)
        for (std::size_t i = 0; i < options.size(); i += 2) {
            std::vector<std::string> words = command;
            words.insert(words.end(), {options[i], options[i + 1]});
            const Outcome outcome = prt(words);
            EXPECT_EQ(outcome.status, 2) << options[i] << " " << options[i + 1] << outcome.err;
            EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        }
    EXPECT_EQ(prt({"project", "light.json", "-o", ""}).status, 2);
    EXPECT_EQ(folder.files(), 1u);
}

TEST_F(Output, ClosedOrFullStandardStreamsSetTheStatus) {
    for (const char* closed : {">&-", ">/dev/full", ">&- 2>&- <&-", ">/dev/full 2>/dev/full"}) {
        const Outcome outcome = shell(bake("--json out.json " + std::string(closed)));
        EXPECT_EQ(outcome.status, 1) << closed << outcome.err;
        EXPECT_EQ(folder.files(), 1u) << closed; // none of the outputs exists
    }
    for (const char* closed : {"2>&-", "2>/dev/full", "<&- 2>&-"}) {
        EXPECT_EQ(shell(bake(closed)).status, 0) << closed;
        EXPECT_EQ(shell(PRT_PROGRAM " info missing.glb " + std::string(closed)).status, 1) << closed;
        EXPECT_EQ(shell(PRT_PROGRAM " nonsense " + std::string(closed)).status, 2) << closed;
    }
    EXPECT_EQ(shell(PRT_PROGRAM " --help >/dev/full").status, 1);
}

TEST_F(Output, FailedReportsRemoveTheOutput) {
    folder.file("out.glb", "old");
    EXPECT_EQ(shell(bake("--json /dev/full")).status, 1);
    EXPECT_EQ(text_in(folder / "out.glb"), "old");
    EXPECT_EQ(folder.files(), 2u);
}

TEST_F(Output, StreamsAreWrittenAndKept) {
    ASSERT_TRUE(std::filesystem::is_symlink("/dev/stdout"));
    const Outcome outcome = shell(PRT_PROGRAM " info good.glb --json /dev/stdout >both && cat both");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_symlink("/dev/stdout"));
    const std::size_t json = outcome.out.find("\n{\n"); // after the printed text
    ASSERT_NE(json, std::string::npos) << outcome.out;
    EXPECT_TRUE(outcome.out.starts_with("good.glb: ")) << outcome.out;
    EXPECT_TRUE(outcome.out.ends_with("}\n")) << outcome.out;
    EXPECT_NE(shell(PRT_PROGRAM " info good.glb --json /dev/stdout | cat").out.find("\n{\n"),
              std::string::npos);
    EXPECT_EQ(shell(bake("--json /dev/null")).status, 0);
    EXPECT_EQ(shell(PRT_PROGRAM " bake good.glb -o /dev/null --rays 4 --order 2 --device cpu").status, 0);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    const Outcome pipe = shell("mkfifo pipe; cat pipe & " PRT_PROGRAM " info good.glb --json pipe; wait");
    EXPECT_TRUE(pipe.out.ends_with("}\n")) << pipe.out << pipe.err;
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

TEST_F(Output, TerminalControlCharactersAreNotPrinted) {
    GlbFile file = triangle_file();
    file.json["images"] = {{{"uri", "no\nsuch\x1b]0;title\x07\xc2\x9b.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.json["extensionsRequired"] = {"\x1b[31mEXT\r\nprt: error: forged"};
    file.write(folder / "a.glb");
    file.json.erase("extensionsRequired");
    file.write(folder / "b.glb");
    std::filesystem::copy_file(scene, folder / "c\n\x1b[1m.glb");
    for (const char* name : {"a.glb", "b.glb", "c\n\x1b[1m.glb"}) {
        const Outcome outcome = prt({"bake", (folder / name).string(), "-o",
                                     (folder / "c\n\x1b.glb").string(), "--rays", "4", "--device", "cpu"});
        EXPECT_LE(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        for (const std::string& text : {outcome.out, outcome.err})
            for (const char c : text) {
                const int byte = static_cast<unsigned char>(c);
                EXPECT_TRUE(byte == '\n' || (byte >= 0x20 && byte != 0x7f)) << byte << " in " << text;
            }
        EXPECT_EQ(outcome.out.find("\xc2\x9b"), std::string::npos);
        EXPECT_EQ(outcome.err.find("\xc2\x9b"), std::string::npos);
        EXPECT_EQ(outcome.out.find("\n\\x1b"), std::string::npos) << outcome.out;
    }
    const Outcome plain = prt({"info", (folder / "Bäume 木 🌲.glb").string()});
    EXPECT_NE(plain.err.find("Bäume 木 🌲.glb"), std::string::npos) << plain.err;
}

TEST_F(Output, ConcurrentWritersLeaveOneCompleteFile) {
    ASSERT_EQ(shell(bake("")).status, 0);
    const std::string one = text_in(folder / "out.glb");
    ASSERT_EQ(shell(bake("--seed 7")).status, 0);
    const std::string other = text_in(folder / "out.glb");
    ASSERT_NE(one, other);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(shell(bake(" & ") + bake("--seed 7; a=$?; wait $! && exit $a")).status, 0);
        const std::string winner = text_in(folder / "out.glb");
        EXPECT_TRUE(winner == one || winner == other);
        EXPECT_EQ(folder.files(), 2u);
    }
}

TEST_F(Output, CancelledPicturesLeaveNoFile) {
    ASSERT_EQ(shell(bake("")).status, 0);
    folder.file("light.json", R"({"prtkit_light": 1, "order": 2,
                                  "coefficients": {"red": [1, 0, 0, 0], "green": [1, 0, 0, 0],
                                                   "blue": [1, 0, 0, 0]}})");
    const std::string render = PRT_PROGRAM " render out.glb --lights light.json -o p.exr --device cpu ";
    for (const char* after : {"0", "2"}) { // seconds; signals that come before it listens are ignored
        const Outcome outcome =
            shell("trap '' INT; " + render + "--size 4096x4096 --samples 1 & sleep " + after +
                  "; while kill -INT $! 2>/dev/null; do sleep 0.1; done; wait $!");
        EXPECT_EQ(outcome.status, 1) << outcome.err;
        EXPECT_TRUE(outcome.err.ends_with("prt: error: cancelled\n")) << outcome.err;
        EXPECT_EQ(outcome.err.find("cancelled"), outcome.err.rfind("cancelled")) << outcome.err;
        EXPECT_EQ(folder.files(), 3u);
    }
}

/// Returns limits of descriptors, of file sizes and, unless a sanitizer reserves terabytes, of address space.
std::vector<std::string> limits() {
    std::vector<std::string> list = {"ulimit -n 8", "ulimit -f 1"};
#if !__has_feature(address_sanitizer)
    list.emplace_back("ulimit -v 1000000");
#endif
    return list;
}

TEST_F(Output, LimitedResourcesSufficeOrAreReportedInOneLine) {
    for (const std::string& limit : limits()) {
        std::filesystem::remove(folder / "out.glb");
        const Outcome outcome = shell(limit + "; " + bake(""));
        EXPECT_LE(outcome.status, 1) << limit << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), outcome.status) << outcome.err;
        EXPECT_EQ(std::filesystem::exists(folder / "out.glb"), outcome.status == 0);
    }
}

} // namespace
} // namespace prt::test
